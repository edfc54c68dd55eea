/* Keys belong to what has the focus. The site has shortcuts of its own ("/" and Ctrl+K search,
   Escape, arrows), which its scripts hear at the document or above it. While an editor, a control
   or a picture has the focus they hear nothing; the search field keeps its own keys. */
(function () {
  "use strict";

  const CONTROLS = "input, select, textarea, button, summary, label, [contenteditable], "
    + "[role=application], [role=textbox], [role=button], [role=slider], [role=switch], "
    + "[role=tab], .pf-answer, .pf-labbar, .pf-explorable";
  const SEARCH = "[role=search], .search-button__wrapper, dialog, input[name=q]";
  const MAC = /^(Mac|iPhone|iPad)/.test(navigator.platform);

  function inControl(event) {
    const at = event.target;
    return at instanceof Element && Boolean(at.closest(CONTROLS)) && !at.closest(SEARCH);
  }

  /* The theme hears Ctrl+K (on a Mac Command+K) before anybody else, so it is stopped there; no
     control of a page uses it. */
  addEventListener("keydown", (event) => {
    const command = MAC ? event.metaKey : event.ctrlKey;
    if (command && /^k$/i.test(event.key) && inControl(event)) event.stopImmediatePropagation();
  }, true);

  /* All else has been through the control itself by now, and ends below the document. */
  document.documentElement.addEventListener("keydown", (event) => {
    if (inControl(event)) event.stopPropagation();
  });
})();
