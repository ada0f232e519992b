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
    def bounds(self, /) -> list[Incomplete]:
        """
        The lowest and the highest values of `reactions` for elastic joints; without columns if no
        bounds were requested.
        """
    def chosen(self, /) -> list[tuple[str, Incomplete]]:
        """
        The columns of `reactions` for each choice, with its name.
        """
    @property
    def document(self, /) -> str: ...
    @property
    def q(self, /) -> Incomplete: ...
    @property
    def reaction_names(self, /) -> list[str]: ...
    def stopped(self, /) -> Any | None:
        """
        The exception with the reason why the run stopped before its end, if an error stopped it.
        """
    @property
    def t(self, /) -> Incomplete: ...
    def tables(self, /) -> list[tuple[Incomplete, list[tuple[str, str, str]]]]:
        """
        The trajectory, the reactions and the loads, each with its columns.
        """
    @property
    def v(self, /) -> Incomplete: ...

@final
class Scene:
    """
    The text of a scene. The text does not change; results that were computed from it are stored.
    """
    def __new__(cls, /, name: str, text: str) -> Scene: ...
    def ask(self, /, question: str, options: str, others: SupportsGetItem[int, Scene], common: Incomplete, files: bool) -> tuple[str, list[tuple[str, bytes]]]:
        """
        Answers a question, given by its name, about this scene and further scenes, with its options
        as a JSON object; returns the document, and the files if they are requested.
        """
    def case(self, /, name: str) -> Scene:
        """
        Returns the scene with the values of one of its load cases.
        """
    @staticmethod
    def from_file(path: str | PathLike[str]) -> Scene:
        """
        Reads a file.
        """
    @staticmethod
    def imported(format: str, path: str | PathLike[str], text: str | None, base: str, fixed: bool, snap: bool, keyframe: str | None, model: str | None, drives: str, pose: SupportsGetItem[int, tuple[str, SupportsFloat | SupportsIndex]], loops: str | PathLike[str] | None) -> tuple[Scene, list[str], list[tuple[str, str, int]]]:
        """
        Converts a robot model to a scene. Returns the scene, its remarks, and the omitted elements
        as pairs of kind and subject.
        """
    def matrices(self, /, q: SupportsGetItem[int, SupportsFloat | SupportsIndex] | None, v: SupportsGetItem[int, SupportsFloat | SupportsIndex] | None, t: SupportsFloat | SupportsIndex, max_memory: SupportsIndex | str | None) -> tuple[Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete]:
        """
        Returns C, the diagonal of M, Γ, Q, b and Φ at coordinates and velocities; `None` selects
        those of the start.
        """
    @property
    def name(self, /) -> str: ...
    def names(self, /) -> tuple[str, list[list[str]]]:
        """
        Returns the name that the scene states, the names of its bodies, of its joints and drives in
        the order of the rows, and of its load cases.
        """
    @staticmethod
    def of_template(name: str) -> Scene:
        """
        Returns the scene of a template.
        """
    def simulate(self, /, options: Incomplete, numbers_of_choice: bool, choices: SupportsGetItem[int, str], on_event: Any | None, on_row: Any | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]]) -> Run:
        """
        Runs the scene. With `numbers_of_choice`, numbers that are not determined on their stretch
        of the run have the values for the independent rows of the run; otherwise they are NaN.
        `choices` have separate arrays. `drives` are functions of time, joint coordinate and rate
        that replace laws; `forces` are functions of the states of bodies. Each has its name.
        """
    def simulate_into(self, /, directory: str | PathLike[str], options: Incomplete, choices: SupportsGetItem[int, str], until: SupportsFloat | SupportsIndex | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]]) -> str:
        """
        Runs the scene and writes the files of the command into a directory; returns the summary.
        With `until` the run ends at the row of this time (s), like a run that was requested to end
        there.
        """
    def state(self, /, t: SupportsFloat | SupportsIndex, common: Incomplete, drop: SupportsGetItem[int, SupportsIndex] | None) -> tuple[list[float], list[float]]:
        """
        Returns coordinates and velocities at a time of the motion; the velocities are empty if they
        are unknown.
        """
    @property
    def text(self, /) -> str: ...
    def view(self, /, path: str | PathLike[str], scale: SupportsFloat | SupportsIndex | None, common: Incomplete) -> tuple[bytes, str]:
        """
        Returns the assembled start as a page or a picture, selected by the extension of a file
        name, and the characters of a PNG that no font contains.
        """
    def with_settings(self, /, keys: SupportsGetItem[int, str], expressions: SupportsGetItem[int, str]) -> Scene:
        """
        Returns the same scene with other numbers or expressions.
        """

@final
class Sweep:
    """
    A scene with its varied numbers.
    """
    def __new__(cls, /, name: str, text: str, vary: SupportsGetItem[int, str], keep_rows: bool) -> Sweep: ...
    def make(self, /, directory: str | PathLike[str], k: SupportsIndex, n: SupportsIndex, threads: SupportsIndex, on_runs: Any | None, stop: Any | None) -> tuple[str, int, bool]:
        """
        Performs the unfinished runs of a shard. Returns the summary of the shard, the number of
        runs that were performed, and whether the tables of all runs were written.

        `on_runs` receives the number of finished runs and of failed runs among them, from time to
        time; the shard ends if `on_runs` or `stop` returns `True`.
        """
    @property
    def runs(self, /) -> int:
        """
        Number of runs of all shards.
        """
    def seconds(self, /, run: SupportsIndex) -> float:
        """
        Performs a run without writing any file, and returns its time (s).
        """
    def shards(self, /, directory: str | PathLike[str]) -> int | None:
        """
        Returns the number of shards of a directory, if its files determine it.
        """
    def unfinished(self, /, directory: str | PathLike[str], n: SupportsIndex) -> list[int]:
        """
        Returns the shards, of n, that are not finished.
        """

def _panics() -> None:
    """
    Panics, for the test that no panic leaves this module.
    """

def explain(code: str) -> str:
    """
    Returns the meaning of the code of an error, and the possible remedies.
    """

def forget_crashed(directory: str | PathLike[str]) -> int:
    """
    Deletes the rows of runs that ended their process, so that these runs are repeated. Returns the
    number of these runs.
    """

def input_code() -> str:
    """
    Returns the code of invalid input.
    """

def merge(directories: SupportsGetItem[int, str | PathLike[str]], into: str | PathLike[str]) -> str:
    """
    Writes the tables of the results in some directories. Returns the summary of the tables.
    """

def nearest(name: str, known: SupportsGetItem[int, str]) -> str | None:
    """
    Returns the known name that is most similar to a name, if there is one.
    """

def sweep_columns(directory: str | PathLike[str]) -> tuple[str, list[tuple[str, Any]]]:
    """
    Returns the summary of the results in a directory, and its columns: counts as integers, or with
    NaN if some are unknown, numbers, and lists of texts.
    """

def templates() -> list[tuple[str, str]]:
    """
    Returns names of the templates, each with its description.
    """
