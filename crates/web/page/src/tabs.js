// Tabs of the page. On a wide page, the scene and the picture are always visible and have no tab.

import { byId, make } from "./dom.js";

const NARROW = matchMedia("(max-width: 820px)");

export class Tabs {
  #tabs = new Map();

  /**
   * @param {[id: string, label: string, kind: "tab" | "narrow" | "never"][]} views
   *   A view of the kind `narrow` is a tab only on a narrow page. A view without a tab is visible.
   */
  constructor(list, views, onShow) {
    Object.assign(this, { list, views, onShow });
    for (const [id, label] of views) {
      const tab = make("button", {
        type: "button", id: `tab-${id}`, textContent: label, onclick: () => this.show(id),
        aria: { role: "tab", controls: id },
      });
      this.#tabs.set(id, tab);
      list.append(tab);
    }
    list.addEventListener("keydown", (event) => this.#move(event));
    NARROW.addEventListener("change", () => this.#arrange());
    this.#arrange();
  }

  get isNarrow() {
    return NARROW.matches;
  }

  /** Shows or hides a tab. */
  offer(id, isOffered) {
    this.#tabs.get(id).dataset.offered = isOffered;
    if (!isOffered && this.current === id) this.show("verdicts");
    this.#arrange();
  }

  show(id) {
    this.current = id;
    document.body.dataset.view = id;
    this.#arrange();
    this.onShow(id);
  }

  #arrange() {
    const isTab = (id) => {
      const kind = this.views.find(([own]) => own === id)[2];
      const isOffered = this.#tabs.get(id).dataset.offered !== "false";
      return isOffered && (kind === "tab" || (kind === "narrow" && this.isNarrow));
    };
    if (!this.current || !isTab(this.current)) {
      this.current = "verdicts";
      document.body.dataset.view = this.current;
    }
    for (const [id] of this.views) {
      const [tab, panel, isChosen] = [this.#tabs.get(id), byId(id), this.current === id];
      tab.hidden = !isTab(id);
      tab.setAttribute("aria-selected", isChosen);
      tab.tabIndex = isChosen ? 0 : -1;
      panel.classList.toggle("shown", isChosen || (!isTab(id) && tab.dataset.offered !== "false"));
      if (isTab(id)) {
        panel.setAttribute("role", "tabpanel");
        panel.setAttribute("aria-labelledby", tab.id);
      } else {
        panel.removeAttribute("role");
        panel.removeAttribute("aria-labelledby");
      }
    }
  }

  #move(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined) return;
    const shown = [...this.#tabs].filter(([, tab]) => !tab.hidden).map(([id]) => id);
    const at = shown.indexOf(this.current);
    const next = Number.isFinite(step) ? (at + step + shown.length) % shown.length
      : step < 0 ? 0 : shown.length - 1;
    event.preventDefault();
    this.show(shown[next]);
    this.#tabs.get(shown[next]).focus();
  }
}
