# Written by `python python/build.py --write-stubs` from the compiled module.

"""
The private module.
"""

from _typeshed import Incomplete, SupportsGetItem
from os import PathLike
from typing import Any, Final, SupportsFloat, SupportsIndex, final

__all__ = ["__version__", "Run", "Scene", "Sweep", "_panics", "explain", "forget_crashed", "input_code", "merge", "nearest", "sweep_columns", "templates"]

__version__: Final[str]
"""
The version of the package.
"""

@final
class Run:
    """
    A run. Arrays have a row for each time.
    """
    def chosen(self, /) -> list[tuple[str, Incomplete]]:
        """
        The columns of `reactions` by each choice, with its name.
        """
    @property
    def columns(self, /) -> list[tuple[str, str, str]]: ...
    @property
    def document(self, /) -> str: ...
    @property
    def q(self, /) -> Incomplete: ...
    @property
    def reaction_columns(self, /) -> list[tuple[str, str, str]]: ...
    @property
    def reaction_names(self, /) -> list[str]: ...
    @property
    def reactions(self, /) -> Incomplete: ...
    def stopped(self, /) -> Any | None:
        """
        The exception that says why the run stopped before its end, if it did so by itself.
        """
    @property
    def t(self, /) -> Incomplete: ...
    @property
    def trajectory(self, /) -> Incomplete: ...
    @property
    def v(self, /) -> Incomplete: ...

@final
class Scene:
    """
    The text of a scene. It does not change; what was read from it is kept.
    """
    def __new__(cls, /, name: str, text: str) -> Scene: ...
    def ask(self, /, question: str, options: str, others: SupportsGetItem[int, Scene], common: Incomplete, files: bool) -> tuple[str, list[tuple[str, bytes]]]:
        """
        Asks a question by its name about this scene and perhaps others, with its options as a JSON
        object; returns the document, and the files if they are asked for.
        """
    @staticmethod
    def from_file(path: str | PathLike[str]) -> Scene:
        """
        Reads a file.
        """
    @staticmethod
    def imported(format: str, path: str | PathLike[str], text: str | None, base: str, fixed: bool, snap: bool, keyframe: str | None, pose: SupportsGetItem[int, tuple[str, SupportsFloat | SupportsIndex]], loops: str | PathLike[str] | None) -> tuple[Scene, list[str], list[tuple[str, str, int]]]:
        """
        Makes a scene of a model of a robot. Returns it, and what it says of itself: remarks, and
        what is left out as pairs of kind and subject.
        """
    def matrices(self, /, q: SupportsGetItem[int, SupportsFloat | SupportsIndex] | None, v: SupportsGetItem[int, SupportsFloat | SupportsIndex] | None, t: SupportsFloat | SupportsIndex, max_memory: SupportsIndex | str | None) -> tuple[Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete]:
        """
        C, the diagonal of M, Γ, Q, b and Φ at coordinates and velocities; those of the start if
        they are `None`.
        """
    @property
    def name(self, /) -> str: ...
    def names(self, /) -> tuple[str, list[str], list[str]]:
        """
        The name that the scene gives itself, the names of its bodies, and of its joints and drives
        in the order of the rows.
        """
    @staticmethod
    def of_template(name: str) -> Scene:
        """
        The scene of a template.
        """
    def simulate(self, /, options: Incomplete, numbers_of_choice: bool, choices: SupportsGetItem[int, str], on_event: Any | None, on_row: Any | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]]) -> Run:
        """
        Runs the scene. With `numbers_of_choice` numbers that are not determined on their stretch of
        the run are those of the rows that the run keeps, otherwise NaN; `choices` have arrays of
        their own. `drives` are functions of time, measure and rate in place of laws, `forces`
        functions of the states of bodies, each with its name.
        """
    def simulate_into(self, /, directory: str | PathLike[str], options: Incomplete, choices: SupportsGetItem[int, str], until: SupportsFloat | SupportsIndex | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]]) -> str:
        """
        Runs the scene and writes the files of the command into a directory; returns the summary.
        With `until` the run ends at the row of this time (s), as one that was asked to end there.
        """
    def state(self, /, t: SupportsFloat | SupportsIndex, common: Incomplete, drop: SupportsGetItem[int, SupportsIndex] | None) -> tuple[list[float], list[float]]:
        """
        Coordinates and velocities at a time of the motion; the velocities are empty if none are
        known.
        """
    @property
    def text(self, /) -> str: ...
    def view(self, /, path: str | PathLike[str], scale: SupportsFloat | SupportsIndex | None, common: Incomplete) -> tuple[bytes, str]:
        """
        The assembled start as a page or a picture, by the end of a name; with the characters that
        no font of a PNG has.
        """
    def with_settings(self, /, keys: SupportsGetItem[int, str], expressions: SupportsGetItem[int, str]) -> Scene:
        """
        The same scene with other numbers or expressions.
        """

@final
class Sweep:
    """
    A scene and what is varied in it.
    """
    def __new__(cls, /, name: str, text: str, vary: SupportsGetItem[int, str], keep_rows: bool) -> Sweep: ...
    def make(self, /, directory: str | PathLike[str], k: SupportsIndex, n: SupportsIndex, threads: SupportsIndex, on_runs: Any | None, stop: Any | None) -> tuple[str, int, bool]:
        """
        Makes the runs of a shard that are not finished. Returns its summary, the number of runs
        that were made, and whether the tables of all runs were written.

        `on_runs` gets the number of finished runs and of failed ones among them, from time to time;
        the shard ends where it or `stop` returns `True`.
        """
    @property
    def runs(self, /) -> int:
        """
        Number of runs of all shards.
        """
    def seconds(self, /, run: SupportsIndex) -> float:
        """
        Makes a run without writing anything, and returns how long that took (s).
        """
    def shards(self, /, directory: str | PathLike[str]) -> int | None:
        """
        The number of shards in which a directory is being filled, if it tells.
        """
    def unfinished(self, /, directory: str | PathLike[str], n: SupportsIndex) -> list[int]:
        """
        Which of n shards are not finished.
        """

def _panics() -> None:
    """
    Panics, for the test that no panic leaves this module.
    """

def explain(code: str) -> str:
    """
    What the code of an error means, and what to do.
    """

def forget_crashed(directory: str | PathLike[str]) -> int:
    """
    Forgets the rows of runs that have ended their process, so that they are made again. Returns
    their number.
    """

def input_code() -> str:
    """
    The code of wrong input.
    """

def merge(directories: SupportsGetItem[int, str | PathLike[str]], into: str | PathLike[str]) -> str:
    """
    Writes the tables of what is in some directories. Returns the summary.
    """

def nearest(name: str, known: SupportsGetItem[int, str]) -> str | None:
    """
    The known name that is most similar to a name, if one is.
    """

def sweep_columns(directory: str | PathLike[str]) -> tuple[str, list[tuple[str, Any]]]:
    """
    The summary of what is in a directory, and its columns: counts as whole numbers, or with NaN if
    some are unknown, numbers, and lists of texts.
    """

def templates() -> list[tuple[str, str]]:
    """
    Names of the templates, each with what it is.
    """
