// A page of the module in a frame: the start, or the report of a run. Its scripts draw the
// mechanism, and send and receive events.

const DATA = '<script id="data" type="application/json">';
/** Shows only the picture of a page. */
const PICTURE_ONLY = `
html, body { height: 100%; overflow: hidden; } body { padding: 0; max-width: none; }
header, .panel, .first-order, #motion > h2, #motion > p, main > :not(#motion) { display: none; }
main, #motion, .stage { height: 100%; } .stage { grid-template-columns: minmax(0, 1fr); gap: 0; }
.picture { border: 0; border-radius: 0; }
#picture { flex: 1 1 0; height: 0; touch-action: none; }`;

/** The page around the frame has a button for the theme. */
const REPORT = "#theme { display: none; }";

const dataOf = (html) => {
  const from = html.indexOf(DATA) + DATA.length;
  return JSON.parse(html.slice(from, html.indexOf("</script>", from)));
};

/** What must be equal so that a page can show another start without a reload. */
const castOf = ({ t, drawing, joints }) => JSON.stringify([
  t.length, drawing.bodies.map(({ name }) => name), joints.map(({ name, type }) => [name, type]),
  drawing.markers.map(({ name }) => name), drawing.forces.length, drawing.view ?? null,
  drawing.sites.map(({ symbol }) => symbol),
]);

export class Frame {
  #cast = null;
  #waiting = null;

  /**
   * @param {HTMLIFrameElement} element
   * @param {object} options
   * @param {boolean} [options.isPicture] whether only the picture of the page is shown
   * @param {string} [options.at] the section that is visible first
   * @param {Record<string, (detail: object) => boolean | void>} [options.on] a function for each
   *   event of the page; it returns whether it acts
   */
  constructor(element, { isPicture = false, at = null, on = {} } = {}) {
    Object.assign(this, { element, isPicture, at, on });
    element.addEventListener("load", () => this.#listen());
  }

  /** Shows a page. A start of the same mechanism replaces the start without a reload. */
  show(html) {
    const data = this.isPicture ? dataOf(html) : null;
    const cast = data && castOf(data);
    if (cast && cast === this.#cast) {
      if (this.#waiting) this.#waiting = data;
      else this.#send("start", data);
      return;
    }
    this.#cast = cast;
    this.#waiting = data ?? {};
    this.html = html;
    const theme = document.documentElement.dataset.theme;
    const themed = theme ? html.replace("<html", `<html data-theme="${theme}"`) : html;
    const style = this.isPicture ? PICTURE_ONLY : REPORT;
    this.element.srcdoc = themed.replace("</head>", `<style>${style}</style></head>`);
  }

  /** Shows nothing. */
  clear() {
    this.#cast = null;
    this.html = null;
    this.element.srcdoc = "";
  }

  /** Marks a joint. `null` marks no joint. */
  select(joint) {
    this.joint = joint;
    this.#send("select", { joint });
  }

  /** Follows the theme of the page. */
  recolour() {
    const { contentDocument: inner, contentWindow } = this.element;
    if (!inner?.documentElement) return;
    const { theme } = document.documentElement.dataset;
    if (theme) inner.documentElement.dataset.theme = theme;
    contentWindow.dispatchEvent(new contentWindow.Event("themechange"));
  }

  #listen() {
    const inner = this.element.contentDocument;
    for (const [name, act] of Object.entries(this.on)) {
      inner?.addEventListener(`pfaff:${name}`, (event) => act(event.detail) && event.preventDefault());
    }
    if (this.at) inner?.getElementById(this.at)?.scrollIntoView();
    if (this.#cast) this.#send("start", this.#waiting);
    this.#waiting = null;
    if (this.joint) this.select(this.joint);
  }

  #send(name, detail) {
    const { contentDocument: inner, contentWindow } = this.element;
    if (inner) inner.dispatchEvent(new contentWindow.CustomEvent(`pfaff:${name}`, { detail }));
  }
}
