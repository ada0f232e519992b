// Small helpers for the document.

export const byId = (id) => document.getElementById(id);

/** A new HTML element with properties and children. */
export function make(tag, properties = {}, ...children) {
  const { aria = {}, dataset = {}, ...own } = properties;
  const element = Object.assign(document.createElement(tag), own);
  Object.assign(element.dataset, dataset);
  for (const [key, value] of Object.entries(aria)) {
    element.setAttribute(key === "role" ? key : `aria-${key}`, value);
  }
  element.append(...children);
  return element;
}

export const button = (textContent, onclick, properties = {}) =>
  make("button", { type: "button", textContent, onclick, ...properties });

/** The nodes of a text in which names stand between grave accents. */
export const withNames = (text) =>
  text.split("`").map((part, k) => (k % 2 ? make("code", { textContent: part }) : part));

/** Calls a function after a pause without further calls (ms). */
export function afterPause(pause, call) {
  let timer;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(call, pause);
  };
}

/** Offers a file to the user. */
export function download(name, parts, type = "text/plain") {
  const url = URL.createObjectURL(new Blob(parts, { type }));
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
