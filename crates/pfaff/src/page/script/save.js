// Saves the picture and charts as they are seen, in SVG and PNG files that the browser makes.

/** Pixels of a saved PNG for one of the screen, so that it is sharp in print. */
const FINER = 2;
/** Time in which a browser has taken a file (ms). */
const TAKEN = 60_000;

/** Saves a file where the browser saves downloads. */
function download(name, blob) {
  const href = URL.createObjectURL(blob);
  make(null, "a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), TAKEN);
}

/** A name as part of the name of a file on any system. */
function fileWord(name) {
  return name.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^[.-]+|-+$/g, "") || "picture";
}

/** The picture as it is seen now, as text of SVG. */
function svgOf(picture) {
  const recorder = new Recorder();
  picture.paintWith(new Pen(recorder, picture.brush.looks), 1);
  return recorder.written(`${data.name}, t = ${timeInWords(picture.instant.t)} s`);
}

/** The same on a finer canvas. */
function canvasOf(picture) {
  const canvas = document.createElement("canvas");
  picture.paintWith(new Brush(canvas, picture.brush.looks), FINER * (globalThis.devicePixelRatio || 1));
  return canvas;
}

const svgFile = (text) => new Blob([text], { type: "image/svg+xml" });

function setUpSave(picture) {
  const nameOf = (kind) => `${fileWord(data.name)}-t${timeInWords(picture.instant.t)}.${kind}`;
  byId("save-svg").addEventListener("click", () => download(nameOf("svg"), svgFile(svgOf(picture))));
  byId("save-png").addEventListener("click", async () => {
    const name = nameOf("png");
    download(name, await asPng(canvasOf(picture)));
  });
}

/** Heights of the title and of a line of the legend above a chart in a file (px). */
const [TITLE, ENTRY] = [26, 18];

/** A menu of files of a chart, at the end of its caption; its button is returned. */
function saveMenu(chart) {
  const menu = make(chart.caption, "details", { className: "save on-request" });
  const button = make(menu, "summary", { textContent: "⤓", title: "Save chart" });
  const files = make(menu, "div");
  const add = (kind, blobOf) => make(files, "button", { type: "button", textContent: kind }).addEventListener("click", async () => {
    const name = `${fileWord(`${data.name}-${chart.title.textContent}`)}.${kind.toLowerCase()}`;
    menu.open = false;
    button.focus();
    download(name, await blobOf(svgOfChart(chart)));
  });
  add("SVG", svgFile);
  add("PNG", pngFile);
  return button;
}

/** A chart with its title and its legend as text of SVG, in the colours that are seen and without the cursor. */
function svgOfChart(chart) {
  const root = chart.svg.cloneNode(true);
  root.querySelectorAll(".cursor, .dot").forEach((e) => e.remove());
  const [, , width, height] = root.getAttribute("viewBox").split(" ").map(Number);
  const top = addHead(root, chart);
  const paper = draw(null, "rect", { y: -top, height: top + height, class: "paper" });
  root.prepend(paper);
  // Looks are those of the style sheet where the chart is; long words make it wider.
  chart.figure.append(root);
  const wide = Math.max(width, Math.ceil(root.getBBox().width) + 4);
  root.querySelectorAll("rect, path, text").forEach(stateLook);
  root.remove();
  [root, ...root.querySelectorAll("[class]")].forEach((e) => e.removeAttribute("class"));
  ["tabindex", "aria-label"].forEach((name) => root.removeAttribute(name));
  paper.setAttribute("width", wide);
  setAll(root, { width: wide, height: top + height, viewBox: `0 ${-top} ${wide} ${top + height}` });
  root.prepend(draw(null, "title", {}, chart.inWords()));
  return new XMLSerializer().serializeToString(root);
}

/** Draws title and legend above a chart, and returns their height. */
function addHead(root, { series, band, title, badge }) {
  const entries = [...(band ? [{ isBand: true, label: band.label }] : []), ...series];
  const rows = entries.length > 1 ? entries : [];
  const top = TITLE + ENTRY * rows.length;
  draw(root, "text", { x: 4, y: 16 - top, class: "heading" }, [title, badge].map((e) => e.textContent).filter(Boolean).join(": "));
  rows.forEach((row, k) => {
    const y = TITLE - top + ENTRY * (k + 0.5);
    if (row.isBand) draw(root, "path", { d: `M4 ${y - 5}h28v10h-28Z`, class: "band" });
    else draw(root, "path", { d: `M4 ${y}H32`, ...strokeOf(row) });
    draw(root, "text", { x: 40, y: y + 4, class: "entry" }, row.label);
  });
  return top;
}

/** Looks of a chart that become attributes of SVG, with the defaults of SVG, which are left out. */
const LOOK_ATTRIBUTES = { "stroke-width": "1px", "stroke-linejoin": "miter", "stroke-dasharray": "none", opacity: "1" };
const FONT_ATTRIBUTES = ["font-family", "font-size", "font-weight"];

/** Writes the computed look of an element into its attributes. */
function stateLook(element) {
  const style = getComputedStyle(element);
  for (const kind of ["fill", "stroke"]) {
    const [colour, alpha] = plainColour(style[kind]);
    setAll(element, { [kind]: colour, ...(alpha < 1 ? { [`${kind}-opacity`]: alpha } : {}) });
  }
  const fonts = element.tagName === "text" ? FONT_ATTRIBUTES : [];
  for (const name of [...Object.keys(LOOK_ATTRIBUTES), ...fonts]) {
    const value = style.getPropertyValue(name);
    if (value === LOOK_ATTRIBUTES[name]) element.removeAttribute(name);
    else element.setAttribute(name, value);
  }
}

/** SVG as PNG, finer than the screen. */
async function pngFile(text) {
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(text)}`;
  await image.decode();
  const ratio = FINER * (globalThis.devicePixelRatio || 1);
  const canvas = Object.assign(document.createElement("canvas"), { width: ratio * image.width, height: ratio * image.height });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return asPng(canvas);
}

const asPng = (canvas) => new Promise((done) => {
  canvas.toBlob(done);
});
