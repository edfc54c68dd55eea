/* Typesets formulas for typeset.py with MathJax: one line of JSON in, one out.
     { tex, display } -> { html } or { error }
     { finish: true } -> { css }, the rules of all that was typeset
   Called as: node typeset.js <folder es5 of MathJax> <address of the fonts, seen from the style sheet> */
"use strict";

const [, , folder, fontURL] = process.argv;

require(`${folder}/node-main.js`).init({
  loader: { load: ["input/tex-full", "output/chtml", "a11y/assistive-mml"] },
  tex: {
    packages: { "[-]": ["noerrors", "noundefined"] }, // an error is told, not shown in red
    formatError: (_, error) => { throw error; },
  },
  chtml: { fontURL, adaptiveCSS: true },
}).then((MathJax) => {
  const adaptor = MathJax.startup.adaptor;
  const answer = ({ tex, display, finish }) => {
    if (finish) return { css: adaptor.textContent(MathJax.chtmlStylesheet()) };
    MathJax.texReset(); // no label of one page is known to another
    return { html: adaptor.outerHTML(MathJax.tex2chtml(tex, { display })) };
  };
  require("readline").createInterface({ input: process.stdin }).on("line", (line) => {
    let reply;
    try {
      reply = answer(JSON.parse(line));
    } catch (error) {
      reply = { error: String(error.message || error) };
    }
    process.stdout.write(JSON.stringify(reply) + "\n");
  });
});
