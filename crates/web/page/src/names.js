// Where names of bodies and joints stand in the text of a scene.

const NAME = /\bname\s*=\s*(?:"([^"]*)"|'([^']*)')/g;

/** All names with the positions of their keys. */
const namesOf = (text) =>
  Array.from(text.matchAll(NAME), (match) => ({
    name: match[1] ?? match[2], from: match.index, to: match.index + match[0].length,
  }));

/** Returns the place of the item with a name, or `undefined`. */
export const placeOf = (text, name) => namesOf(text).find((own) => own.name === name);

/** Returns the name of the item at a position: on its line, or in its table. */
export function nameAt(text, position) {
  const start = text.lastIndexOf("\n", position - 1) + 1;
  const end = (text.indexOf("\n", position) + text.length + 1) % (text.length + 1);
  const inside = ([from, to]) => namesOf(text.slice(from, to))[0]?.name;
  const onLine = inside([start, end]);
  if (onLine) return onLine;
  const before = text.slice(0, end).search(/^\[(?![\s\S]*^\[)/m);
  const after = text.slice(end).search(/^\[/m);
  return before < 0 ? undefined : inside([before, after < 0 ? text.length : end + after]);
}
