// The scene of the page, where it comes from and where it is kept, and the texts that answers belong
// to.

import { byId } from "./dom.js";
import { allExamples } from "./gallery.js";
import { fromAddress } from "./share.js";

const STORED = "pfaff-scene";

export const isEmbedded = new URLSearchParams(location.search).has("embed");

/** The scene with the page of its start and the report of its run. */
export const scene = { name: "", text: "", page: null, report: null };

/** The scene as requests contain it. */
export const source = () => ({ name: `${scene.name}.toml`, text: scene.text });

/** A name that is a plain name of a file, also in a command. */
export const cleanName = (name) =>
  name.normalize().replace(/[^\p{L}\p{N}_.-]+/gu, "-").replace(/^[-.]+/, "") || "scene";

/** A text as the editor counts it: with LF, and without halves of characters. */
export const cleanText = (text) => (text.toWellFormed?.() ?? text).replace(/\r\n?/g, "\n");

/** The texts to which answers belong, by the identifiers of their elements. */
const answered = new Map();

/** Greys answers to another text. */
export function greyStale() {
  for (const [id, text] of answered) byId(id).classList.toggle("stale", text !== scene.text);
}

/** Notes that elements show answers to a text. */
export function showsAnswerTo(text, ...ids) {
  for (const id of ids) answered.set(id, text);
  greyStale();
}

/** Keeps the scene in the browser. */
export function store() {
  if (isEmbedded) return;
  try {
    localStorage.setItem(STORED, JSON.stringify({ name: scene.name, text: scene.text }));
  } catch {
    // A browser may forbid storage. The scene is then not kept.
  }
}

function stored() {
  try {
    const { name, text } = isEmbedded ? {} : JSON.parse(localStorage.getItem(STORED));
    return typeof name === "string" && typeof text === "string" ? { name, text } : null;
  } catch {
    return null;
  }
}

/** Removes a scene from the address, because it is no longer the scene of the page. */
export function clearAddress() {
  if (location.hash && !isEmbedded) history.replaceState(null, "", location.pathname + location.search);
}

/**
 * Returns the scene of the address, an example that the address names, the kept scene, or the first
 * example, and whether the scene comes from the address, and whether the address is damaged.
 */
export async function firstScene() {
  let isDamaged = false;
  try {
    const shared = await fromAddress(location.hash);
    if (shared) return { first: shared, isShared: true, isDamaged };
  } catch {
    isDamaged = true;
  }
  const named = location.hash.match(/^#example=([\w-]+)$/)?.[1];
  const examples = named ? await allExamples().catch(() => []) : [];
  const example = examples.find(({ name }) => name === named);
  isDamaged ||= Boolean(named && !example);
  return { first: example || stored() || FIRST_EXAMPLE, isShared: false, isDamaged };
}
