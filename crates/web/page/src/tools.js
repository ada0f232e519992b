// The tools in the head of the page: open, save, share, copy, theme.

import { byId, download, make } from "./dom.js";
import { acceptDrops, read } from "./files.js";
import { listOf, say } from "./messages.js";
import { cleanName, scene, store } from "./scene.js";
import { toAddress } from "./share.js";

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied.`);
  } catch {
    say([`${what}: `, make("code", { textContent: text })]);
  }
}

async function share() {
  const hash = await toAddress(scene);
  if (!hash) {
    say("The scene is too long for an address (8 kB). Save it as a file.");
    return;
  }
  history.replaceState(null, "", hash);
  await copy(location.href, "Address of the scene");
}

function setTheme(theme, onTheme) {
  const prefersDark = matchMedia("(prefers-color-scheme: dark)").matches;
  if (theme) document.documentElement.dataset.theme = theme;
  const isDark = (theme ?? (prefersDark ? "dark" : "light")) === "dark";
  byId("theme").textContent = isDark ? "Light" : "Dark";
  byId("theme").onclick = () => setTheme(isDark ? "light" : "dark", onTheme);
  onTheme();
}

/**
 * @param {object} actions
 * @param {import("./module.js").Module} actions.module
 * @param {(scene: {name: string, text: string}) => void} actions.open
 * @param {() => void} actions.onTheme
 */
export function setUpTools({ module, open, onTheme }) {
  const on = (id, act) => byId(id).addEventListener("click", act);
  const openFile = async (file) => {
    if (!file) return;
    const opened = await read(file, module);
    if (opened.error) {
      say(opened.error);
      return;
    }
    open(opened);
    const { format, remarks } = opened;
    if (format) say(listOf(`Imported from ${format}: ${remarks.length} remarks`, remarks));
  };
  on("open", () => byId("file").click());
  byId("file").addEventListener("change", ({ target }) => {
    openFile(target.files[0]);
    target.value = "";
  });
  acceptDrops(byId("drop"), openFile);
  on("save", () => download(`${scene.name}.toml`, [scene.text]));
  on("share", share);
  on("copy-command", () => copy(`pfaff analyze ${scene.name}.toml`, "Command"));
  on("copy-python", () =>
    copy(`import pfaff\n\nprint(pfaff.Scene.from_file("${scene.name}.toml").analyze())\n`, "Python"));
  byId("name").addEventListener("input", ({ target }) => {
    scene.name = cleanName(target.value);
    store();
  });
  byId("name").addEventListener("change", ({ target }) => { target.value = scene.name; });
  setTheme(undefined, onTheme);
}
