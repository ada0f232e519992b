"""An answer of the library, with what was asked."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _arguments as arguments

if TYPE_CHECKING:
    from ._scene import Scene


class Common(NamedTuple):
    """Keywords of all questions."""

    tolerance: float | None = None
    angle_tolerance: float | None = None
    threads: int | None = None
    max_memory: int | str | None = None
    out: str | os.PathLike[str] | None = None

    def checked(self) -> dict[str, Any]:
        """The same by name, once their types are those that are needed."""
        checks: dict[str, Callable[[str, Any], Any]] = {
            "tolerance": arguments.number,
            "angle_tolerance": arguments.number,
            "threads": arguments.count,
            "max_memory": arguments.size,
            "out": arguments.path,
        }
        given = self._asdict()
        return {name: arguments.maybe(check, name, given[name]) for name, check in checks.items()}


class Answer(NamedTuple):
    """An answer."""

    scene: Scene
    """What was asked about."""
    options: dict[str, Any]
    """The options of the question."""
    common: Common
    """Other keywords."""
    document: dict[str, Any]
    """The document."""
    files: dict[str, bytes]
    """Its files by name, if they were asked for."""
