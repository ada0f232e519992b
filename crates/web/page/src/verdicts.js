// The answer of `analyze` as a table, with reasons, bounds and design changes.

import { button, make, withNames } from "./dom.js";

const words = (verdict) => verdict.replaceAll("_", " ");
const badge = (verdict) => make("span", { className: `badge ${verdict}`, textContent: words(verdict) });

const number = (x) => (x === null || x === undefined ? "–"
  : String(Number(x.toPrecision(4))).replace("-", "−"));

/** The facts of a mechanism. */
function tiles({ rank, rows, redundancy, mobility, reactions }) {
  const unique = reactions.filter(({ verdict }) => verdict === "unique").length;
  const facts = [
    [`${unique} of ${reactions.length}`, "unique reactions", "Reactions that the rigid-body model determines"],
    [`${rank} of ${rows}`, "independent rows", "Constraint equations that are independent"],
    [redundancy, "redundancy", "Constraint equations that repeat others"],
    [mobility, "mobility", "Independent motions, with all drives in place"],
  ];
  return make("dl", { className: "tiles" }, ...facts.map(([value, name, title]) =>
    make("div", { title }, make("dt", { textContent: name }), make("dd", { textContent: value }))));
}

function boundsOf({ bounds }) {
  if (!bounds) return "–";
  const [lowest, highest] = [number(bounds.lowest), number(bounds.highest)];
  return lowest === highest ? lowest : `${lowest} … ${highest}`;
}

/** What is known of one reaction. */
function reasons(reaction, { dependencies = [], mixing = [] }) {
  const { explanation, components, magnitude_at_most: most } = reaction;
  const hasBounds = components.some((component) => component.bounds);
  const head = ["Component", "Verdict", ...(hasBounds ? ["Bounds (N, N·m)"] : [])];
  const table = make("table", { className: "components" },
    make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col", textContent: text })))),
    make("tbody", {}, ...components.map((component) => make("tr", {},
      make("th", { scope: "row", textContent: component.name }),
      make("td", {}, badge(component.verdict), component.fragile ? " sensitive to data" : ""),
      ...(hasBounds ? [make("td", { className: "number", textContent: boundsOf(component) })] : [])))));
  const texts = [
    explanation,
    ...dependencies.filter(({ joints }) => joints.includes(reaction.name)).map(({ text }) => text),
    ...mixing.filter(({ reactions }) => reactions.includes(reaction.name)).map(({ text }) => text),
    most?.force ? `The force is at most ${number(most.force)} N.` : null,
    most?.moment ? `The moment is at most ${number(most.moment)} N·m.` : null,
  ].filter(Boolean);
  const list = make("ul", {}, ...texts.map((text) => make("li", {}, ...withNames(text))));
  return make("div", { className: "why" }, components.length ? table : "", texts.length ? list : "");
}

export class Verdicts {
  #rows = new Map();
  #open = new Set();

  /**
   * @param {HTMLElement} element
   * @param {{onSelect: (name: string) => void, onReplace: (remedy: object) => void}} actions
   */
  constructor(element, actions) {
    Object.assign(this, { element, actions });
  }

  show(document) {
    this.#rows.clear();
    const { warnings = [], notes = [], remedies = [], groups = [], bounds } = document;
    const remarks = [...warnings, ...notes].map((own) => (typeof own === "string" ? own : own.text ?? own.message));
    this.element.replaceChildren(
      tiles(document),
      ...remarks.filter(Boolean).map((text) => make("p", { className: "remark" }, ...withNames(text))),
      this.#table(document),
      ...(groups.length ? [this.#groups(groups)] : []),
      ...(remedies.length ? [this.#remedies(remedies)] : []),
      ...(bounds ? [make("p", { className: "grey", textContent: `Bounds are valid ${bounds.assumption}.` })] : []),
    );
    this.select(this.selected);
  }

  /** Marks the row of a reaction. */
  select(name) {
    this.selected = name;
    for (const [own, row] of this.#rows) row.toggleAttribute("data-selected", own === name);
    this.#rows.get(name)?.scrollIntoView?.({ block: "nearest" });
  }

  has(name) {
    return this.#rows.has(name);
  }

  #table(document) {
    const head = ["Joint or drive", "Type", "Reaction", "Why"];
    const rows = document.reactions.flatMap((reaction, index) => this.#row(reaction, document, index));
    // A call has a limited number of arguments.
    const body = make("tbody");
    for (const row of rows) body.append(row);
    return make("table", { className: "verdicts" },
      make("caption", { className: "unseen", textContent: "Verdict for each reaction" }),
      make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col", textContent: text })))),
      body);
  }

  #row(reaction, document, index) {
    const { name, type, verdict, fragile } = reaction;
    const select = () => this.actions.onSelect(name);
    const id = `why-${index}`;
    const isOpen = this.#open.has(name);
    const detail = make("tr", { className: "detail", id, hidden: !isOpen });
    const fill = () => detail.firstChild
      ?? detail.append(make("td", { colSpan: 4 }, reasons(reaction, document)));
    if (isOpen) fill();
    const why = button("why", (event) => {
      event.stopPropagation();
      fill();
      detail.hidden = !detail.hidden;
      why.setAttribute("aria-expanded", !detail.hidden);
      this.#open[detail.hidden ? "delete" : "add"](name);
    }, { className: "link", aria: { expanded: isOpen, controls: id, label: `Why: ${name}` } });
    const row = make("tr", { onclick: select },
      make("th", { scope: "row" }, button(name, (event) => {
        event.stopPropagation();
        select();
      }, { className: "link" })),
      make("td", { textContent: type }),
      make("td", {}, badge(verdict), fragile ? make("span", { className: "grey", textContent: " sensitive to data" }) : ""),
      make("td", {}, why));
    this.#rows.set(name, row);
    return [row, detail];
  }

  #groups(groups) {
    return make("section", { className: "groups" }, make("h2", { textContent: "Sums" }),
      make("ul", {}, ...groups.map(({ name, verdict }) => make("li", {}, make("code", { textContent: name }), " ", badge(verdict)))));
  }

  #remedies(remedies) {
    return make("section", { className: "remedies" }, make("h2", { textContent: "Design changes" }),
      make("ul", {}, ...remedies.map((remedy) => make("li", {},
        make("span", {}, ...withNames(remedy.text)), " ",
        button("Replace in place", () => this.actions.onReplace(remedy), {
          className: "fix",
          aria: { label: `Replace in place: ${remedy.replace.map((own) => `${own.joint} by ${own.to}`).join(", ")}` },
        })))));
  }
}
