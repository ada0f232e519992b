// The problems of a scene: a list with help and fixes. The editor marks their places.

import { button, make, withNames } from "./dom.js";

const SUGGESTION = /did you mean `([^`]+)`/;

/** Adds the fixes of a problem: a proposed name replaces the text of a mark, in its quotes. */
export function withFixes(problem, text) {
  const fixes = problem.marks.flatMap(({ from, to, text: label }, mark) => {
    const found = label.match(SUGGESTION)
      ?? (mark === 0 ? `${problem.message} ${problem.help ?? ""}`.match(SUGGESTION) : null);
    if (!found) return [];
    const old = text.slice(from, to);
    const quote = /^(["']).*\1$/s.test(old) ? old[0] : "";
    const insert = quote + found[1] + quote;
    return [{ mark, from, to, insert, title: `Replace with ${found[1]}` }];
  });
  return { ...problem, fixes };
}

/** Shows problems. */
export function listProblems(list, problems, { text, onGo, onFix, onExplain }) {
  list.hidden = problems.length === 0;
  list.replaceChildren(...problems.map((problem) => {
    const { severity, code, message, help, marks, fixes } = problem;
    const line = marks[0] ? text.slice(0, marks[0].from).split("\n").length : null;
    const item = make("li", { className: severity });
    const labels = marks.map((mark) => mark.text).filter(Boolean);
    item.append(
      make("span", { className: "severity", textContent: severity }),
      button(code, () => onExplain(code, item), { className: "link code", title: `Explain ${code}` }),
      line === null ? "" : button(`Line ${line}`, () => onGo(marks[0]), { className: "link" }),
      make("span", { className: "message" }, ...withNames([message, ...labels].join("; "))),
      ...fixes.map((fix) => button(fix.title, () => onFix(fix), { className: "fix" })),
      help ? make("span", { className: "help" }, ...withNames(help)) : "",
    );
    return item;
  }));
}
