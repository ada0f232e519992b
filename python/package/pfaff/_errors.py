"""The exceptions, with the texts and codes of the command."""

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
    """A position in the text of a scene, or of an imported file."""

    file: str
    """The name of the text."""
    line: int
    """Line (1-based)."""
    column: int
    """Column (1-based), in characters."""

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class Error(Exception):
    """The reason why there is no result. ``str(error)`` is the text of the command."""

    def __init__(self, words: str, document: str = "") -> None:
        super().__init__(words)
        self.document: dict[str, Any] = json.loads(document) if document else {}
        """The document that the command writes with ``--json``."""

    def __reduce__(self) -> tuple[Any, ...]:
        document = json.dumps(self.document) if self.document else ""
        return (type(self), (str(self), document))

    @property
    def code(self) -> str | None:
        """Code of the error, such as ``"P0101"``; ``pfaff explain CODE`` prints its remedies."""
        code: str | None = self.document.get("code")
        return code

    @property
    def problems(self) -> list[dict[str, Any]]:
        """All errors in the text with their positions, messages and hints."""
        problems: list[dict[str, Any]] = self.document.get("problems", [])
        return problems

    @property
    def place(self) -> Place | None:
        """The position of the first error, if the error is in a text."""
        for problem in self.problems:
            label = problem["primary"]
            return Place(problem["file"], label["line"], label["column"])
        return None

    @property
    def hint(self) -> str | None:
        """The remedy for the first error, if it is known."""
        for problem in self.problems:
            hint: str | None = problem["help"]
            return hint
        return None


class SceneError(Error, ValueError):
    """The text of a scene, or of an imported file, is invalid."""


class InputError(Error, ValueError):
    """An argument is invalid, or a file cannot be read."""


class ArgumentError(InputError, TypeError):
    """An argument has a wrong type."""


class ComputationError(Error, ArithmeticError):
    """The input is valid, but the computation stopped."""

    run: Run | None = None
    """Results of a run up to the time at which it stopped."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (*super().__reduce__(), {"run": self.run})


class InternalError(Error, RuntimeError):
    """An internal error of this package."""


def wrong(message: str) -> InputError:
    """Builds the exception for an invalid argument, with the code of invalid input."""
    return InputError(*_words(message))


def wrong_type(name: str, given: object, needed: str) -> ArgumentError:
    """Builds the exception for an argument of a wrong type.

    The text of the exception contains the name of the argument, the given type and the required type.
    """
    kind = "None" if given is None else f"`{type(given).__name__}`"
    return ArgumentError(*_words(f"{name} is {kind}, need {needed}"))


def unknown(what: str, name: str, known: Iterable[str]) -> InputError:
    """Builds the exception for an unknown name, with all names and the most similar name."""
    names = list(known)
    near = nearest(str(name), names)
    advice = f"; did you mean `{near}`?" if near else ""
    return wrong(f"there is no {what} `{name}`; there are: {', '.join(names)}{advice}")


def _words(message: str) -> tuple[str, str]:
    code = input_code()
    document = {"ok": False, "code": code, "error": message, "problems": []}
    return f"error[{code}]: {message}", json.dumps(document)
