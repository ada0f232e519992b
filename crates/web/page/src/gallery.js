// The examples with thumbnails and a search.

import { button, byId, make } from "./dom.js";

const address = (svg) => `data:image/svg+xml,${encodeURIComponent(svg)}`;

let examples;

/** Returns all examples; the first call fetches them. */
export function allExamples() {
  examples ??= fetch("examples.json").then((reply) => reply.json());
  return examples;
}

/** @param {(example: {name: string, text: string}) => void} onChoose */
export function setUpGallery(onChoose) {
  const [gallery, search, cards] = ["gallery", "search", "cards"].map(byId);
  const filter = () => {
    const words = search.value.toLowerCase().split(/\s+/);
    for (const card of cards.children) {
      card.hidden = !words.every((word) => card.textContent.toLowerCase().includes(word));
    }
  };
  const fill = async () => {
    const all = await allExamples();
    cards.replaceChildren(...all.map((example) => {
      const { name, summary, picture } = example;
      const choose = () => {
        gallery.close();
        onChoose(example);
      };
      return make("li", {}, make("button", { type: "button", onclick: choose },
        picture ? make("img", { src: address(picture), alt: "", loading: "lazy" }) : "",
        make("b", { textContent: name }), make("span", { textContent: summary })));
    }));
    filter();
  };
  search.addEventListener("input", filter);
  byId("close-gallery").addEventListener("click", () => gallery.close());
  gallery.addEventListener("click", (event) => event.target === gallery && gallery.close());
  byId("examples").addEventListener("click", () => {
    gallery.showModal();
    search.focus();
    if (!cards.childElementCount) fill();
  });
}
