"""Choices of reactions that are not unique, in the syntax of the command."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeGuard

import numpy as np

from . import _arguments as arguments
from ._errors import unknown, wrong_type

Choice = Sequence[int] | str | Mapping[str, float | tuple[float, float]]
"""A choice of reactions.

It is a list of rows to delete (1-based), ``"kept-rows"``, ``"minimum-norm"`` or
``"minimum-norm:length=L"``, or compliances (m/N, or with rad/(N·m)) of joints by name.
"""


def is_rows(choose: object) -> TypeGuard[Sequence[int]]:
    """Whether a choice is a list of rows to delete."""
    if isinstance(choose, (str, Mapping)) or not isinstance(choose, Iterable):
        return False
    return all(isinstance(row, (int, np.integer)) for row in choose)


def as_words(choose: Choice) -> str:
    """Returns a choice in the syntax of the command."""
    if isinstance(choose, str):
        return choose
    if isinstance(choose, Mapping):
        soft = arguments.named("choose", choose, _compliance, "compliances")
        return "compliance:" + ",".join(f"{name}={words}" for name, words in soft.items())
    return "drop:" + ",".join(map(str, arguments.rows("choose", choose)))


def _compliance(name: str, given: Any) -> str:
    """Returns the compliances along a line and of a rotation (m/N, rad/(N·m))."""
    needed = "a compliance (m/N), or a pair with that of rotation"
    both = given if isinstance(given, tuple) else (given, 0.0)
    if len(both) != 2:
        raise wrong_type(name, given, needed)
    along, turn = (arguments.number(name, x, needed) for x in both)
    return f"{along!r}/{turn!r}"


def as_misfits(misfits: Mapping[str, Sequence[float]] | None) -> str:
    """Returns misfits by name in the syntax of the command."""
    if misfits is None:
        return ""
    found = arguments.named("misfits", misfits, _misfit, "displacements by name")
    return "".join(f";misfit:{name}={words}" for name, words in found.items())


def _misfit(name: str, given: Any) -> str:
    needed = "displacements (m), and rotations (rad) if there are any"
    return ",".join(repr(x) for x in arguments.listed(name, given, arguments.number, needed))


Bounds = Mapping[str, Any]
"""The elastic joints of bounds: the keys ``rigid``, ``within`` and ``compliance``.

``rigid`` lists rigid joints and drives. ``within`` is the largest ratio of compliances to nominal
compliances. ``compliance`` contains nominal compliances by name.
"""


def as_bounds(name: str, bounds: bool | Bounds) -> dict[str, Any] | None:
    """Returns the request for bounds of a run; ``None`` means the request in the scene."""
    if isinstance(bounds, (bool, np.bool_)):
        return {"rigid": [], "within": None, "compliance": None} if bounds else None
    if not isinstance(bounds, Mapping):
        raise wrong_type(name, bounds, "True, False or a dictionary")
    keys = ("rigid", "within", "compliance")
    for key in bounds:
        if key not in keys:
            raise unknown("key of `bounds`", str(key), keys)
    soft = arguments.maybe(_soft, "compliance", bounds.get("compliance"))
    return {
        "rigid": arguments.texts("rigid", bounds.get("rigid", ())),
        "within": arguments.maybe(arguments.number, "within", bounds.get("within")),
        "compliance": None if soft is None else as_words(soft).removeprefix("compliance:"),
    }


def _soft(name: str, given: Any) -> Mapping[str, Any]:
    if not isinstance(given, Mapping):
        raise wrong_type(name, given, "compliances by name")
    return given


def of_run(choose: Choice | Sequence[Choice] | None) -> tuple[bool, list[str]]:
    """Whether values for the independent rows of a run are requested, and the other choices."""
    if choose is None:
        return False, []
    if is_rows(choose) or (isinstance(choose, str) and choose == "kept-rows"):
        return True, []
    if isinstance(choose, (str, Mapping)):
        return False, [as_words(choose)]
    needed = "a choice, or a list of choices"
    return False, arguments.listed("choose", choose, lambda _, one: as_words(one), needed)


def dropped(choose: Choice | Sequence[Choice] | None) -> list[int] | None:
    """Returns the rows that a run treats as dependent."""
    return [int(row) for row in choose] if is_rows(choose) else None
