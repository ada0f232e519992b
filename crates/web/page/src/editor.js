// The editor of a scene: CodeMirror with the keys and problems that the module states.

import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory, redo, undo } from "@codemirror/commands";
import { bracketMatching, indentOnInput, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { Compartment, EditorState, Transaction } from "@codemirror/state";
import {
  drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap,
  lineNumbers,
} from "@codemirror/view";
import { classHighlighter } from "@lezer/highlight";
import { make, withNames } from "./dom.js";

/** The tokens of TOML. */
const toml = StreamLanguage.define({
  name: "toml",
  startState: () => ({ quote: null }),
  token(stream, state) {
    if (state.quote) {
      while (!stream.eol()) {
        if (stream.match(state.quote)) {
          state.quote = null;
          break;
        }
        if (stream.next() === "\\" && state.quote[0] === '"') stream.next();
      }
      return "string";
    }
    if (stream.eatSpace()) return null;
    if (stream.match(/^#.*/)) return "comment";
    if (stream.sol() && stream.match(/^\[\[?[^\]]*\]\]?/)) return "heading";
    // A word is read once, so that long lines take linear time.
    if (stream.match(/^[\w.+-]+/)) {
      const word = stream.current();
      if (stream.match(/^\s*=/, false)) return "propertyName";
      if (/^[+-]?(\d[\w.+-]*|inf|nan)$/.test(word)) return "number";
      return /^(true|false)$/.test(word) ? "bool" : null;
    }
    const quote = stream.match(/^("""|'''|"|')/);
    if (quote) {
      state.quote = quote[0];
      return "string";
    }
    stream.next();
    return "punctuation";
  },
  languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["[", "{", '"'] } },
});

const isBare = (label) => /^(true|false|[+-]?\d[\d.e+-]*)$/.test(label);

/** The text that a completion inserts. */
function insertion({ label, kind }, isQuoted, after) {
  if (kind === "key") return /^\s*=/.test(after) ? label : `${label} = `;
  return kind === "section" || isQuoted || isBare(label) ? label : `"${label}"`;
}

const completing = (module) => async (context) => {
  const { state, pos, explicit } = context;
  const word = context.matchBefore(/[\w-]+|["[{,]\s*$|=\s*$/);
  if (!explicit && !word) return null;
  const request = { call: "complete", text: state.doc.toString(), offset: pos };
  const { done } = await module.ask(request, { kind: "complete", urgent: true });
  if (!done?.options.length || context.aborted) return null;
  const after = state.sliceDoc(done.to, done.to + 20);
  const options = done.options.map((option) => ({
    label: option.label,
    type: option.kind,
    info: option.detail || undefined,
    boost: option.is_required ? 9 : 0,
    apply: insertion(option, done.is_quoted, after),
  }));
  return { from: done.from, to: done.to, options, validFor: /^[\w-]*$/ };
};

const hovering = (module) => hoverTooltip(async (view, pos) => {
  const request = { call: "hover", text: view.state.doc.toString(), offset: pos };
  const { done } = await module.ask(request, { kind: "hover", urgent: true });
  if (!done) return null;
  const create = () => ({
    dom: make("div", { className: "hover" }, make("code", { textContent: done.title }), ` ${done.text}`),
  });
  return { pos: done.from, end: done.to, above: true, create };
});

/** The smallest change from the text of the editor to another text. */
function changeTo(doc, text) {
  const old = doc.toString();
  const most = Math.min(old.length, text.length);
  let start = 0;
  while (start < most && old[start] === text[start]) start += 1;
  let end = 0;
  while (end < most - start && old.at(-1 - end) === text.at(-1 - end)) end += 1;
  return { from: start, to: old.length - end, insert: text.slice(start, text.length - end) };
}

export class Editor {
  /**
   * @param {object} options
   * @param {HTMLElement} options.parent
   * @param {import("./module.js").Module} options.module
   * @param {(text: string) => void} options.onChange called after changes of the user
   * @param {(position: number) => void} options.onCursor
   */
  constructor({ parent, text, label, module, onChange, onCursor = () => {} }) {
    this.isSilent = false;
    this.history = new Compartment();
    const extensions = [
      lineNumbers(), highlightActiveLineGutter(), this.history.of(history()), drawSelection(), indentOnInput(),
      bracketMatching(), closeBrackets(), highlightActiveLine(), highlightSelectionMatches(),
      search({ top: true }), EditorView.lineWrapping, toml, syntaxHighlighting(classHighlighter), lintGutter(),
      autocompletion({ override: [completing(module)] }), hovering(module),
      keymap.of([
        ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap,
        ...completionKeymap, ...lintKeymap, indentWithTab,
      ]),
      EditorView.contentAttributes.of({
        "aria-label": label, "aria-describedby": "leave", spellcheck: "false", tabindex: "0",
      }),
      EditorView.updateListener.of((update) => {
        if (update.docChanged && !this.isSilent) onChange(this.text);
        const isByUser = update.transactions.some((own) => own.isUserEvent("select"));
        if (update.selectionSet && isByUser) onCursor(update.state.selection.main.head);
      }),
    ];
    this.view = new EditorView({ doc: text, parent, extensions });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  /** Replaces the text as one step of the history. */
  replace(text) {
    this.view.dispatch({
      changes: changeTo(this.view.state.doc, text),
      annotations: isolateHistory.of("full"),
    });
  }

  /** Replaces the text without a step of the history and without a call of `onChange`. */
  preview(text) {
    this.isSilent = true;
    this.view.dispatch({
      changes: changeTo(this.view.state.doc, text),
      annotations: Transaction.addToHistory.of(false),
    });
    this.isSilent = false;
  }

  /** Begins another scene, with an empty history. */
  open(text) {
    this.view.dispatch({ effects: this.history.reconfigure([]) });
    this.isSilent = true;
    this.view.dispatch({
      changes: changeTo(this.view.state.doc, text), effects: this.history.reconfigure(history()),
    });
    this.isSilent = false;
  }

  undo() {
    undo(this.view);
  }

  redo() {
    redo(this.view);
  }

  /** Selects a part of the text, without a move of the focus. */
  select({ from, to }) {
    this.view.dispatch({
      selection: { anchor: from, head: to },
      effects: EditorView.scrollIntoView(from, { y: "center" }),
    });
  }

  focus() {
    this.view.focus();
  }

  /** Replaces a part of the text. */
  change({ from, to }, insert) {
    this.view.dispatch({ changes: { from, to, insert }, annotations: isolateHistory.of("full") });
  }

  /** Marks problems, which the function `problemsOf` of the page made. */
  mark(problems) {
    const { length } = this.view.state.doc;
    const diagnostics = problems.flatMap(({ severity, message, help, marks, fixes }) =>
      marks.map(({ from, to, text }, k) => {
        const words = k > 0 ? text : [message, text, help].filter(Boolean).join("\n");
        return {
          from: Math.min(from, length),
          to: Math.min(to, length),
          severity: k > 0 ? "info" : severity,
          message: words,
          renderMessage: () => make("span", {}, ...withNames(words)),
          actions: fixes.filter((fix) => fix.mark === k).map((fix) => ({
            name: fix.title,
            apply: () => this.change(fix, fix.insert),
          })),
        };
      }));
    diagnostics.sort((a, b) => a.from - b.from);
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }
}
