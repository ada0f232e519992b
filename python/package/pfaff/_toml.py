"""Python values as TOML, and tables of a scene."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from typing import Any, SupportsFloat, SupportsIndex

from ._errors import wrong_type


def value(of: Any) -> str:
    """Returns a value as TOML. The reader of scenes decides whether the value is valid."""
    if hasattr(of, "tolist"):
        of = of.tolist()
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, str):
        return string(of)
    if isinstance(of, Mapping):
        entries = ", ".join(f"{string(str(key))} = {value(item)}" for key, item in of.items())
        return f"{{ {entries} }}" if entries else "{}"
    if isinstance(of, SupportsIndex) and not hasattr(of, "__len__"):
        return str(int(of))
    if isinstance(of, Iterable):
        return f"[{', '.join(value(item) for item in of)}]"
    if isinstance(of, SupportsFloat):
        return number(float(of))
    raise wrong_type("a value", of, "a number, a text, a list or a dict")


def number(of: float) -> str:
    """Returns a number with the shortest text that reads back to the same bits."""
    if math.isfinite(of):
        text = repr(of)
        return text if "." in text or "e" in text else f"{text}.0"
    return "nan" if math.isnan(of) else "inf" if of > 0 else "-inf"


def string(of: str) -> str:
    """Returns a text in quotes. TOML has the escapes of JSON, and also requires an escaped DEL."""
    text = json.dumps(of, ensure_ascii=False).replace("\x7f", "\\u007f")
    # A lone surrogate is not a character: TOML cannot contain it.
    return text.encode("utf-8", "replace").decode("utf-8")


def table(header: str, entries: Mapping[str, Any]) -> str:
    """Returns a table with its header. Entries that are ``None`` are omitted."""
    lines = [header]
    for key, item in entries.items():
        if item is not None:
            lines.append(f"{key if key.isidentifier() and key.isascii() else string(key)} = {value(item)}")
    return "\n".join(lines) + "\n"
