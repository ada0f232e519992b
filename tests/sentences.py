#!/usr/bin/env python3
"""Draw sentences from the prose of the repository, for readers who have seen only these sentences.

python3 tests/sentences.py 200 > sentences.txt

The sources are Markdown pages, doc comments of Rust, docstrings of Python, help texts and error
messages. The seed is the hash of the commit, so that the same commit gives the same sentences.
"""

from __future__ import annotations

import random
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: Not written by us, or written by programs.
OMITTED = ("THIRD-PARTY.md", "/generated", "docs/api/", "tables.md", "table.md", "settings.md", "report.md", "tests/ui/")


def git(*arguments: str) -> str:
    """Return the output of git."""
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True, encoding="utf-8")
    return done.stdout


def paragraphs_of_page(text: str) -> Iterator[str]:
    """Yield the paragraphs and list items of a page, without tables, headings and code."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        block = re.sub(r"^\s*(?:[-*>]|\d+\.) ", "", block.strip())
        if block and block[0] not in "|#<[!`":
            yield " ".join(block.split())


def paragraphs_of_rust(text: str) -> Iterator[str]:
    """Yield the paragraphs of doc comments, and texts of programs of six words and more."""
    # Tests within a file are at its end.
    text = re.split(r"^#\[cfg\(test\)\]\nmod \w+ \{", text, flags=re.MULTILINE)[0]
    lines = [re.match(r"\s*//[/!] ?(.*)$", line) for line in text.splitlines()]
    page = "\n".join(line.group(1) if line else "\n" for line in lines)
    yield from paragraphs_of_page(page)
    for quoted in re.findall(r'"((?:[^"\\\n]|\\.|\\\n)*)"', re.sub(r"^\s*//.*$", "", text, flags=re.MULTILINE)):
        words = " ".join(re.sub(r"\\\n\s*", "", quoted).split())
        is_prose = len(re.findall(r"(?<![\w.])[a-z]{2,}(?![\w(.=])", words)) > 2
        if is_prose and len(words.split()) > 5 and "<" not in words and "=" not in words[:20] and "\\n" not in words[:-2]:
            yield words


def paragraphs_of_python(text: str) -> Iterator[str]:
    """Yield the paragraphs of docstrings."""
    for docstring in re.findall(r'"""(.*?)"""', text, flags=re.DOTALL):
        # Scenes and programs in tests.
        if re.match(r"\s*(\[|import |from |\w+ = )", docstring):
            continue
        yield from paragraphs_of_page(re.sub(r"^ +", "", docstring, flags=re.MULTILINE))


#: Abbreviations in names of persons and journals, and of editions; they do not end a sentence.
ABBREVIATION = re.compile(
    r"\b(?:[A-Z]|Acta|Anal|Appl|Autom|Comput|Dyn|Eng|Int|Math|Mech|Meth|Multibody|Numer|Optim|Phys|Proc|Sci|Soc"
    r"|Softw|Stat|Statist|Syst|Trans|ed|et al)\.$"
)


def sentences_of(paragraph: str) -> Iterator[str]:
    """Yield the sentences of a paragraph."""
    sentence = ""
    for part in re.split(r"(?<=[.!?])\s+(?=[A-Z`])", paragraph):
        sentence = f"{sentence} {part}".strip()
        if not ABBREVIATION.search(sentence):
            yield sentence
            sentence = ""
    if sentence:
        yield sentence


def sentences() -> list[str]:
    """Return all sentences, each once, in the order of the files."""
    found: dict[str, None] = {}
    readers = {".md": paragraphs_of_page, ".rs": paragraphs_of_rust, ".py": paragraphs_of_python}
    for name in git("ls-files").splitlines():
        reader = readers.get(Path(name).suffix)
        if reader is None or any(part in name for part in OMITTED):
            continue
        is_test = "/tests" in name or name.startswith("tests/") or name.endswith("tests.rs")
        if is_test and name.endswith(".rs"):
            continue
        for paragraph in reader((ROOT / name).read_text(encoding="utf-8")):
            for sentence in sentences_of(paragraph):
                if 5 <= len(sentence.split()) <= 60:
                    found[sentence] = None
    return list(found)


def main() -> None:
    """Print the requested number of sentences, numbered."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    draw = random.Random(git("rev-parse", "HEAD").strip())
    for number, sentence in enumerate(draw.sample(sentences(), count), 1):
        print(f"{number}. {sentence}")


if __name__ == "__main__":
    main()
