"""Notebooks are well formed and complete, and every cell runs."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

FOLDER = ROOT / "python" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
SCRIPT = ROOT / "python" / "notebooks.py"


def _run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-W", "error", str(SCRIPT), *map(str, arguments)]
    return subprocess.run(words, capture_output=True, encoding="utf-8", check=False, timeout=600)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_it_computes(path: Path) -> None:
    done = _run(path)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_form_of_a_notebook(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    notebook: dict[str, Any] = json.loads(text)
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    cells = notebook["cells"]
    assert 10 <= len(cells) <= 20
    ids = [cell["id"] for cell in cells]
    assert len(set(ids)) == len(ids)
    assert all(re.fullmatch(r"[a-zA-Z0-9-_]{1,64}", name) for name in ids)
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert {cell["cell_type"] for cell in cells} == {"markdown", "code"}
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell["outputs"]]
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    assert pictures and max(map(len, pictures)) < 60_000
    # Numbers in sentences must be asserted.
    assert sum("assert " in "".join(cell["source"]) for cell in code) >= 5
    # A notebook must not contain properties of one machine, or commands of one shell.
    assert not re.search(r"0x[0-9a-f]{6}|/home/|/root/|/tmp/|^ *\"[%!]", text, re.MULTILINE)


def test_a_notebook_that_shows_something_else_fails(tmp_path: Path) -> None:
    def notebook(source: str) -> Path:
        cell = {"cell_type": "code", "id": "a", "metadata": {}, "source": [source]}
        cells = [{**cell, "execution_count": None, "outputs": []}]
        path = tmp_path / "a.ipynb"
        document = {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
        path.write_text(json.dumps(document), encoding="utf-8")
        return path

    draw = "import matplotlib.pyplot as plt\nplt.plot([0, {}])\nprint({})\n1 + {}"
    path = notebook(draw.format(1, 2, 3))
    assert _run(path).returncode == 1
    assert _run("--write", path).returncode == 0
    assert _run(path).returncode == 0
    shown = json.loads(path.read_text(encoding="utf-8"))["cells"][0]["outputs"]
    assert [output["output_type"] for output in shown] == ["stream", "execute_result", "display_data"]
    assert shown[1]["data"]["text/plain"] == ["4"]
    stored = path.read_text(encoding="utf-8")
    for other, words in (
        (stored.replace("print(2)", "print(5)"), "shows otherwise"),
        (stored.replace("1 + 3", "1 + 4"), "shows otherwise"),
        (stored.replace("[0, 1]", "[1, 0]"), "the picture of cell 1"),
    ):
        assert other != stored
        path.write_text(other, encoding="utf-8")
        done = _run(path)
        assert done.returncode == 1 and words in done.stdout
    raises = notebook("assert 1 == 2")
    assert _run(raises).returncode == 1
    warns = notebook("import warnings\nwarnings.warn('old')")
    assert "old" in _run(warns).stderr
