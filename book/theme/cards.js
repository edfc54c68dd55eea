/* What a term means, on a card beside the link to it: when the pointer rests on the link, and at
   once when the link has the focus. The card can be pointed at, and Escape takes it away. The
   definitions come with the first card (glossary.js, written by glossary_cards.py). */
(function () {
  "use strict";

  const LINKS = ".bd-article a[href*='glossary.html#term-'], .bd-article a[href^='#term-']";
  const HERE = document.currentScript.src.replace(/[^/]*$/, "");
  const REST = 250, LEAVE = 200; // ms
  const card = document.createElement("div");
  card.id = "pf-card";
  card.className = "pf-card";
  card.setAttribute("role", "tooltip");
  card.hidden = true;
  let loading, link = null, timer;

  function load() {
    loading = loading || new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = `${HERE}glossary.js`;
      script.onload = resolve;
      script.onerror = reject;
      document.head.append(script);
    });
    return loading;
  }

  async function show(at) {
    link = at;
    try {
      await load();
    } catch {
      loading = null; // without definitions the link still leads to the glossary
      return;
    }
    const meaning = window.pfGlossary[at.hash.slice(1)];
    if (link !== at || !meaning || at.classList.contains("headerlink")) return;
    card.innerHTML = meaning; // written by us when the book was built
    if (!card.isConnected) document.body.append(card);
    card.hidden = false;
    at.setAttribute("aria-describedby", card.id);
    place(at.getClientRects()[0]);
  }

  /* Below the link if there is room, else above it; never over an edge of the window. */
  function place(box) {
    const { offsetWidth: w, offsetHeight: h } = card;
    const below = box.bottom + 6, fits = below + h < innerHeight;
    card.style.left = `${Math.max(8, Math.min(box.left, document.documentElement.clientWidth - w - 8))}px`;
    card.style.top = `${fits ? below : Math.max(8, box.top - h - 6)}px`;
  }

  function hide() {
    clearTimeout(timer);
    if (link) link.removeAttribute("aria-describedby");
    link = null;
    card.hidden = true;
  }

  const later = (action, ms) => { clearTimeout(timer); timer = setTimeout(action, ms); };
  const linkOf = ({ target }) => target instanceof Element && target.closest(LINKS);

  document.addEventListener("pointerover", (event) => {
    if (event.pointerType === "touch") return;
    const over = linkOf(event);
    if (over && over !== link) later(() => { hide(); show(over); }, REST);
    else if (over || card.contains(event.target)) clearTimeout(timer);
    else if (link) later(hide, LEAVE);
    else clearTimeout(timer);
  });
  document.addEventListener("focusin", (event) => {
    const at = linkOf(event);
    hide();
    if (at && at.matches(":focus-visible")) show(at);
  });
  document.addEventListener("focusout", hide);
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
  addEventListener("scroll", () => { // the focus may have moved the page
    if (link && !card.hidden) place(link.getClientRects()[0]);
  }, { passive: true });
})();
