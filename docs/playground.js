// Adds a link to each scene of the book that opens the scene in the playground of the site.
(() => {
  const playground = new URL("../", document.currentScript.src);

  /** The text as the address of the playground: deflated, in base64url. */
  async function address(name, text) {
    const bytes = new Blob([JSON.stringify({ name, text })]).stream();
    const packed = bytes.pipeThrough(new CompressionStream("deflate-raw"));
    const all = new Uint8Array(await new Response(packed).arrayBuffer());
    const base64 = btoa(String.fromCharCode(...all));
    return base64.replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
  }

  for (const code of document.querySelectorAll("code.language-toml")) {
    const text = code.textContent;
    if (!/^\s*(\[scene\]|scene\s*=)/m.test(text) || !/^\s*(\[\[body\]\]|body\s*=)/m.test(text)) continue;
    const name = /name\s*=\s*"([^"]+)"/.exec(text)?.[1] ?? "scene";
    const link = document.createElement("a");
    link.textContent = "Open in the playground";
    link.className = "playground-link";
    link.href = playground.href;
    code.closest("pre").after(link);
    address(name, text).then((packed) => { link.hash = `1=${packed}`; });
  }
})();
