// Scenes in the address of the page: `#1=` and the compressed JSON text of the name and the scene.

const PREFIX = "#1=";
/** The longest address of a scene (characters). Longer addresses are cut by some programs. */
const LONGEST = 8192;

/** The longest scene of an address (bytes). A short address can unpack to much more. */
const LARGEST = 1 << 20;

async function through(bytes, stream) {
  const parts = [];
  let size = 0;
  for await (const part of new Blob([bytes]).stream().pipeThrough(stream)) {
    size += part.length;
    if (size > LARGEST) throw new Error("too large");
    parts.push(part);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/**
 * Returns the part of the address for a scene, or `null` if it would be too long.
 * @param {{name: string, text: string}} scene
 */
export async function toAddress({ name, text }) {
  const json = new TextEncoder().encode(JSON.stringify({ name, text }));
  if (json.length > LARGEST) return null;
  const packed = await through(json, new CompressionStream("deflate-raw"));
  const binary = Array.from(packed, (byte) => String.fromCharCode(byte)).join("");
  const base64 = btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  return base64.length + PREFIX.length <= LONGEST ? PREFIX + base64 : null;
}

/** Returns the scene of an address, or `null` without a scene. Throws if the scene is damaged. */
export async function fromAddress(hash) {
  if (!hash.startsWith(PREFIX)) return null;
  const base64 = hash.slice(PREFIX.length).replaceAll("-", "+").replaceAll("_", "/");
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const json = await through(packed, new DecompressionStream("deflate-raw"));
  const { name, text } = JSON.parse(new TextDecoder().decode(json));
  if (typeof name !== "string" || typeof text !== "string") throw new Error("no scene");
  return { name, text };
}
