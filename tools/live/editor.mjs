/* The cell editor: CodeMirror 6 with Python, joined into one classic script by build.py. */
import { EditorState, Compartment } from "@codemirror/state";
import { EditorView, keymap, lineNumbers, drawSelection, highlightSpecialChars } from "@codemirror/view";
import { defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting, HighlightStyle } from "@codemirror/language";
import { closeBrackets, closeBracketsKeymap } from "@codemirror/autocomplete";
import { python } from "@codemirror/lang-python";
import { tags as t } from "@lezer/highlight";

const colours = (c) => syntaxHighlighting(HighlightStyle.define([
  { tag: [t.keyword, t.operatorKeyword], color: c.keyword, fontWeight: "600" },
  { tag: [t.string, t.special(t.string)], color: c.string },
  { tag: [t.number, t.bool, t.null], color: c.number },
  { tag: t.comment, color: c.comment, fontStyle: "italic" },
  { tag: [t.function(t.variableName), t.function(t.definition(t.variableName))], color: c.call },
]));
const light = colours({ keyword: "#7c2d92", string: "#1b6e3c", number: "#9a3f06", comment: "#57606a", call: "#1f5c9c" });
const dark = colours({ keyword: "#dca6f2", string: "#8fdcaa", number: "#ffb783", comment: "#a3aeb9", call: "#8cc0fa" });

/* options: doc, label, dark, onChange(text), onRun(), onCheck(), onLeave() */
window.PFEditor = function (parent, options) {
  const look = new Compartment();
  const view = new EditorView({
    parent,
    state: EditorState.create({
      doc: options.doc,
      extensions: [
        lineNumbers(), history(), drawSelection(), highlightSpecialChars(), bracketMatching(),
        closeBrackets(), indentOnInput(), indentUnit.of("    "), python(),
        look.of(options.dark ? dark : light),
        EditorView.contentAttributes.of({ "aria-label": options.label, spellcheck: "false", tabindex: "0" }),
        keymap.of([
          { key: "Shift-Enter", run: () => { options.onRun(); return true; } },
          { key: "Mod-Enter", run: () => { options.onCheck(); return true; } },
          /* Tab indents, so Escape leaves the editor: nobody gets caught in it. */
          { key: "Escape", run: () => { options.onLeave(); return true; } },
          ...closeBracketsKeymap, ...defaultKeymap, ...historyKeymap, indentWithTab,
        ]),
        EditorView.updateListener.of((u) => { if (u.docChanged) options.onChange(u.state.doc.toString()); }),
      ],
    }),
  });
  return {
    get: () => view.state.doc.toString(),
    /* A transaction of its own, so that undo brings the old text back. */
    set: (text) => view.dispatch({
      changes: { from: 0, to: view.state.doc.length, insert: text },
      annotations: isolateHistory.of("full"),
    }),
    theme: (isDark) => view.dispatch({ effects: look.reconfigure(isDark ? dark : light) }),
    focus: () => view.focus(),
  };
};
