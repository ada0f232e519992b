"""Checks of arguments. A check returns the argument, or raises an exception with its name.

The text of the exception also contains the given value and the required type.
"""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from ._errors import wrong, wrong_type

T = TypeVar("T")

_LARGEST = 2**63
"""Exclusive upper limit of counts."""


def maybe(check: Callable[[str, Any], T], name: str, given: Any) -> T | None:
    """Returns ``None`` for ``None``, and otherwise the result of a check."""
    return None if given is None else check(name, given)


def number(name: str, given: Any, needed: str = "a number") -> float:
    """Checks a number."""
    is_number = hasattr(given, "__float__") or hasattr(given, "__index__")
    if not is_number or getattr(given, "shape", ()) != ():
        raise wrong_type(name, given, needed)
    try:
        return float(given)
    except TypeError:
        raise wrong_type(name, given, needed) from None
    except (ValueError, OverflowError) as error:
        raise wrong(f"{name} cannot be read as a number: {error}") from None


def finite(name: str, given: Any, needed: str = "a number") -> float:
    """Checks that a number is neither NaN nor infinite."""
    found = number(name, given, needed)
    if not np.isfinite(found):
        raise wrong(f"{name} is {found}, need a finite number")
    return found


def finite_or_word(name: str, given: Any) -> float | str:
    """Checks a finite number, or a text."""
    return given if isinstance(given, str) else finite(name, given, "a number or a text")


def count(name: str, given: Any) -> int:
    """Checks a whole number ≥ 0."""
    try:
        whole = operator.index(given)
    except TypeError:
        raise wrong_type(name, given, "a whole number") from None
    if not 0 <= whole < _LARGEST:
        raise wrong(f"{name} is {whole}, need a whole number from 0 to 2^63 - 1")
    return whole


def text(name: str, given: Any) -> str:
    """Checks a text."""
    if not isinstance(given, str):
        raise wrong_type(name, given, "a text")
    return given


def flag(name: str, given: Any) -> bool:
    """Checks a truth value."""
    if not isinstance(given, (bool, np.bool_)):
        raise wrong_type(name, given, "True or False")
    return bool(given)


def instance(name: str, given: Any, of: type[T]) -> T:
    """Checks an instance of a class of this package."""
    if not isinstance(given, of):
        raise wrong_type(name, given, f"a {of.__name__}")
    return given


def path(name: str, given: Any) -> str:
    """Checks a path."""
    try:
        return os.fsdecode(given)
    except TypeError:
        raise wrong_type(name, given, "a path") from None


def size(name: str, given: Any) -> int | str:
    """Checks a number of bytes, or a text such as ``"4GB"``."""
    if isinstance(given, str):
        return given
    try:
        return count(name, given)
    except TypeError:
        raise wrong_type(name, given, "a number of bytes, or a text as `4GB`") from None


def function(name: str, given: Any, of: str) -> Callable[..., Any]:
    """Checks a function."""
    if not callable(given):
        raise wrong_type(name, given, f"a function of {of}")
    return given  # type: ignore[no-any-return]


def listed(name: str, given: Any, check: Callable[[str, Any], T], needed: str) -> list[T]:
    """Checks a list; a text is not accepted."""
    if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
        raise wrong_type(name, given, needed)
    return [check(f"{name}[{k}]", item) for k, item in enumerate(given)]


def texts(name: str, given: Any) -> list[str]:
    """Checks a list of texts."""
    return listed(name, given, text, "a list of texts")


def settings(name: str, given: Any) -> list[str]:
    """Checks texts such as ``"KEY=VALUE"``, or values by key."""
    if isinstance(given, Mapping):
        by_key = named(name, given, text, "texts by key")
        return [f"{key}={value}" for key, value in by_key.items()]
    return listed(name, given, text, "texts as KEY=VALUE, or values by key")


def rows(name: str, given: Any) -> list[int]:
    """Checks rows (1-based)."""
    return listed(name, given, count, "a list of rows, from 1")


def named(name: str, given: Any, check: Callable[[str, Any], T], needed: str) -> dict[str, T]:
    """Checks values by name."""
    if not isinstance(given, Mapping):
        raise wrong_type(name, given, needed)
    return {text(f"a key of {name}", key): check(f"{name}[{key!r}]", of) for key, of in given.items()}
