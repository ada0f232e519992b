"""Runs notebooks and compares their outputs with the stored outputs, or stores the new outputs.

The command is `python python/notebooks.py [NOTEBOOK …]` with the interpreter of the environment.
Without an argument, it runs all notebooks in `python/notebooks`. `--write` stores the outputs.
Cells are run in the same way as in Jupyter: one after the other in one namespace, and the last
expression and the figures are shown. No kernel is used, because a kernel would require thirty
further packages. Texts must be equal. Pictures may differ in a few pixels, and in any way if the
cell has the tag `varies-by-machine`.
"""

from __future__ import annotations

import argparse
import ast
import base64
import contextlib
import difflib
import io
import json
import os
import sys
import warnings
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib import pyplot

FOLDER = Path(__file__).resolve().parent / "notebooks"

VARIES = "varies-by-machine"
"""The tag of cells with pictures that depend on run times or on rounding errors."""

COLOURS = 64
"""Number of colours of a stored picture: enough for lines on white, with a third of the size."""

DPI = 72

DIFFERS = 0.15
"""A pixel differs if a colour differs by more than this share of its range, beyond rounding."""

PIXELS = 1e-3
"""Share of the pixels of a picture that may differ; a displaced line changes a larger share."""


def shown(value: Any) -> dict[str, Any]:
    """The forms in which a value is shown."""
    data = {"text/plain": lines(repr(value))}
    html = getattr(value, "_repr_html_", None)
    if html is not None:
        data = {"text/html": lines(html()), **data}
    return data


def lines(text: str) -> list[str]:
    """Returns a text in the form in which notebooks store texts."""
    return text.splitlines(keepends=True)


def picture(figure: Any) -> str:
    """Returns a figure as a PNG with few colours."""
    from PIL import Image

    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=DPI, bbox_inches="tight")
    small = io.BytesIO()
    with Image.open(drawn) as image:
        image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(small, "PNG", optimize=True)
    return base64.b64encode(small.getvalue()).decode("ascii")


class Cell:
    """A cell that is run, with its outputs in the form of notebooks, in order of appearance."""

    def __init__(self) -> None:
        self.outputs: list[dict[str, Any]] = []
        self._printed = io.StringIO()

    def show(self, *_: object, **__: object) -> None:
        """Stores the text so far, then all figures; for `pyplot.show` and the end of each cell."""
        self._words()
        for number in pyplot.get_fignums():
            figure = pyplot.figure(number)
            data = {"image/png": picture(figure), "text/plain": [repr(figure)]}
            self.outputs.append({"data": data, "metadata": {}, "output_type": "display_data"})
        pyplot.close("all")

    def _words(self) -> None:
        text = self._printed.getvalue()
        if text:
            self.outputs.append({"name": "stdout", "output_type": "stream", "text": lines(text)})
            self._printed.seek(0)
            self._printed.truncate()

    def run(self, source: str, name: str, names: dict[str, Any], count: int) -> None:
        """Runs the cell, and shows the value of the last expression."""
        tree = ast.parse(source, name)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        pyplot.show = self.show
        value = None
        with contextlib.redirect_stdout(self._printed):
            exec(compile(tree, name, "exec"), names)
            if isinstance(last, ast.Expr):
                value = eval(compile(ast.Expression(last.value), name, "eval"), names)
        result = {"execution_count": count, "metadata": {}, "output_type": "execute_result"}
        if value is not None and not source.rstrip().endswith(";"):
            # Jupyter shows figures that are still open after the value.
            self._words()
            self.outputs.append({"data": shown(value), **result})
        self.show()


def run(notebook: dict[str, Any], path: Path) -> None:
    """Runs all cells and replaces the stored outputs."""
    names: dict[str, Any] = {"__name__": "__main__"}
    count = 0
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        count += 1
        name = f"{path.name}, cell {count}"
        cell["execution_count"] = count
        made = Cell()
        made.run("".join(cell["source"]), name, names, count)
        cell["outputs"] = made.outputs


def pixels(text: str) -> Any:
    """Returns a picture as an array of colours from 0 to 1."""
    from PIL import Image

    with Image.open(io.BytesIO(base64.b64decode(text))) as image:
        return np.asarray(image.convert("RGB"), dtype=np.float64) / 255.0


def without_picture(output: dict[str, Any]) -> dict[str, Any]:
    """Returns an output without its picture."""
    data = output.get("data", {})
    return {**output, "data": {kind: x for kind, x in data.items() if kind != "image/png"}}


def same_pictures(old: str, new: str) -> bool:
    """Whether two pictures are equal up to a few pixels."""
    before, now = pixels(old), pixels(new)
    if before.shape != now.shape:
        return False
    differs = np.abs(before - now).max(axis=2) > DIFFERS
    return float(differs.mean()) <= PIXELS


def differences(old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    """Returns the differences between shown and stored outputs, cell by cell."""
    found = []
    for count, (before, now) in enumerate(zip(old["cells"], new["cells"], strict=True), 1):
        if before["cell_type"] != "code":
            continue
        texts = [
            json.dumps([without_picture(output) for output in cell["outputs"]], indent=1, ensure_ascii=False)
            for cell in (before, now)
        ]
        if texts[0] != texts[1]:
            was, is_ = (text.splitlines() for text in texts)
            diff = difflib.unified_diff(was, is_, "stored", "now", lineterm="", n=1)
            found.append(f"cell {count} shows otherwise than it is stored:\n" + "\n".join(diff))
            continue
        if VARIES in now["metadata"].get("tags", []):
            continue
        for pair in zip(before["outputs"], now["outputs"], strict=True):
            pictures = [output.get("data", {}).get("image/png", "") for output in pair]
            if pictures != ["", ""] and not same_pictures(*pictures):
                found.append(f"the picture of cell {count} is not the one that is stored")
    return found


def written(notebook: dict[str, Any]) -> str:
    """Returns the text of a notebook."""
    return json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("notebooks", nargs="*", type=Path)
    parser.add_argument("--write", action="store_true", help="store the outputs")
    arguments = parser.parse_args()
    matplotlib.use("agg")
    warnings.simplefilter("error")
    failed = False
    for path in arguments.notebooks or sorted(FOLDER.glob("*.ipynb")):
        path = path.resolve()
        # Jupyter runs a notebook in its folder.
        os.chdir(path.parent)
        stored = json.loads(path.read_text(encoding="utf-8"))
        notebook = json.loads(json.dumps(stored))
        matplotlib.rcdefaults()
        run(notebook, path)
        if arguments.write:
            path.write_text(written(notebook), encoding="utf-8", newline="\n")
            continue
        found = differences(stored, notebook)
        failed = failed or bool(found)
        print(f"{path.name}: {'; '.join(found) or 'shows what is stored'}")
    if failed:
        sys.exit("`python python/notebooks.py --write` stores what they show now")


if __name__ == "__main__":
    main()
