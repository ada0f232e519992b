"""The exceptions. All of them say what the command says, with its codes."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._pfaff import input_code, nearest

if TYPE_CHECKING:
    from ._run import Run


@dataclass(frozen=True)
class Place:
    """A place in the text of a scene, or of an imported file."""

    file: str
    """The name of the text."""
    line: int
    """Line, from 1."""
    column: int
    """Column, from 1, in characters."""

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class Error(Exception):
    """Why there is no result. ``str(error)`` is the text of the command."""

    def __init__(self, words: str, document: str = "") -> None:
        super().__init__(words)
        self.document: dict[str, Any] = json.loads(document) if document else {}
        """The document that the command writes with ``--json``."""

    def __reduce__(self) -> tuple[Any, ...]:
        document = json.dumps(self.document) if self.document else ""
        return (type(self), (str(self), document))

    @property
    def code(self) -> str | None:
        """Its code, as ``"P0101"``; ``pfaff explain CODE`` tells what to do."""
        code: str | None = self.document.get("code")
        return code

    @property
    def problems(self) -> list[dict[str, Any]]:
        """All places in the text that are wrong, with messages and hints."""
        problems: list[dict[str, Any]] = self.document.get("problems", [])
        return problems

    @property
    def place(self) -> Place | None:
        """The first wrong place, if the fault is in a text."""
        for problem in self.problems:
            label = problem["primary"]
            return Place(problem["file"], label["line"], label["column"])
        return None

    @property
    def hint(self) -> str | None:
        """What to do about the first problem, if that is known."""
        for problem in self.problems:
            hint: str | None = problem["help"]
            return hint
        return None


class SceneError(Error, ValueError):
    """The text of a scene, or of an imported file, is wrong."""


class InputError(Error, ValueError):
    """An argument is wrong, or a file cannot be read."""


class ArgumentError(InputError, TypeError):
    """An argument has a wrong type."""


class ComputationError(Error, ArithmeticError):
    """The input is right, but the computation stopped."""

    run: Run | None = None
    """What a run had computed before it stopped."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (*super().__reduce__(), {"run": self.run})


class InternalError(Error, RuntimeError):
    """A fault of this package."""


def wrong(message: str) -> InputError:
    """The exception for a wrong argument, with the code of wrong input."""
    return InputError(*_words(message))


def wrong_type(name: str, given: object, needed: str) -> ArgumentError:
    """The exception for an argument of a wrong type: its name, what is given, what is needed."""
    kind = "None" if given is None else f"`{type(given).__name__}`"
    return ArgumentError(*_words(f"{name} is {kind}, need {needed}"))


def unknown(what: str, name: str, known: Iterable[str]) -> InputError:
    """The exception for an unknown name, with all names and the nearest one."""
    names = list(known)
    near = nearest(str(name), names)
    advice = f"; did you mean `{near}`?" if near else ""
    return wrong(f"there is no {what} `{name}`; there are: {', '.join(names)}{advice}")


def _words(message: str) -> tuple[str, str]:
    code = input_code()
    document = {"ok": False, "code": code, "error": message, "problems": []}
    return f"error[{code}]: {message}", json.dumps(document)
