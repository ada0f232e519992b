// Messages of the page.

import { button, byId, make, withNames } from "./dom.js";

/** Shows a message, with buttons for actions. */
export function say(text, ...actions) {
  const close = button("✕", hush, { className: "link", aria: { label: "Close message" } });
  byId("message").replaceChildren(make("span", {}, ...[text].flat()), ...actions, close);
  byId("message").hidden = false;
}

/** Closes the message. */
export function hush() {
  byId("message").hidden = true;
}

/** A list of sentences under a title, closed if it is long. */
export const listOf = (title, lines) => make("details", { open: lines.length < 6 },
  make("summary", { textContent: title }),
  make("ul", {}, ...lines.map((line) => make("li", {}, ...withNames(line)))));

/** Shows what the module wrote before it failed. */
export function sayCrash(text, isRestarted) {
  const first = isRestarted ? "The analysis program failed; the page made a new instance."
    : "The analysis program could not be loaded.";
  say([first, make("pre", { textContent: text })]);
}

/** Shows the state of the analysis. */
export function state(text) {
  byId("state").textContent = text;
}
