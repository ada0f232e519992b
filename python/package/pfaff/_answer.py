"""An answer of the library, with its request."""

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
        """Returns the keywords by name, after a check of their types."""
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
    """An answer of the library."""

    scene: Scene
    """Subject of the question."""
    options: dict[str, Any]
    """The options of the question."""
    common: Common
    """The keywords of all questions."""
    document: dict[str, Any]
    """The document of the answer."""
    files: dict[str, bytes]
    """Files of the answer by name, if they were requested."""
