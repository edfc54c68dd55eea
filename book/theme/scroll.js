/* What scrolls sideways can be reached with the keyboard, at every width. (The theme sees to code
   once, when the page loads.) */
(function () {
  "use strict";

  const WIDE = ".bd-article :is(pre:not(.pf-answer pre), div.math, mjx-container[display='true'])";
  const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      if (target.scrollWidth > target.clientWidth) target.tabIndex = 0;
      else target.removeAttribute("tabindex");
    }
  });
  for (const e of document.querySelectorAll(WIDE)) watch.observe(e);
})();
