# Written by `python python/build.py --write-stubs` from the compiled module.

"""
The private module.
"""

from _typeshed import Incomplete, SupportsGetItem
from os import PathLike
from typing import Any, Final, SupportsFloat, SupportsIndex, final

__all__ = ["__version__", "Kinematics", "Run", "Scene", "Simulator", "Sweep", "_panics", "explain", "forget_crashed", "input_code", "merge", "nearest", "sweep_columns", "templates"]

__version__: Final[str]
"""
The version of the package.
"""

@final
class Kinematics:
    """
    The positions, joint coordinates and measures of a mechanism at any state.
    """
    def body(self, /, body: SupportsIndex, q: SupportsGetItem[int, SupportsFloat | SupportsIndex], v: SupportsGetItem[int, SupportsFloat | SupportsIndex]) -> tuple[float, Any, Any, float, Any, Any]:
        """
        The state of the centre of mass of a body.
        """
    def coordinates(self, /, t: SupportsFloat | SupportsIndex, q: SupportsGetItem[int, SupportsFloat | SupportsIndex], v: SupportsGetItem[int, SupportsFloat | SupportsIndex]) -> list[list[float]]:
        """
        The joint coordinates of the drives by laws and their rates.
        """
    def measures(self, /, q: SupportsGetItem[int, SupportsFloat | SupportsIndex], v: SupportsGetItem[int, SupportsFloat | SupportsIndex]) -> list[list[float]]:
        """
        The measures and their rates.
        """
    def names(self, /) -> list[list[str]]:
        """
        The names of the bodies, of the drives by laws with the springs on joint coordinates, and of
        the measures.
        """
    @property
    def start_time(self, /) -> float:
        """
        The time of the start (s).
        """
    def words(self, /) -> list[list[str]]:
        """
        What each coordinate and each velocity is, in words.
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
    def kinematics(self, /) -> Kinematics:
        """
        Returns positions, joint coordinates and measures at any state.
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
    def simulate(self, /, options: Incomplete, numbers_of_choice: bool, choices: SupportsGetItem[int, str], on_event: Any | None, on_row: Any | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]], controller: Any | None, start: tuple[SupportsFloat | SupportsIndex, SupportsGetItem[int, SupportsFloat | SupportsIndex], SupportsGetItem[int, SupportsFloat | SupportsIndex]] | None) -> Run:
        """
        Runs the scene. With `numbers_of_choice`, numbers that are not determined on their stretch
        of the run have the values for the independent rows of the run; otherwise they are NaN.
        `choices` have separate arrays. `drives` are functions of time, joint coordinate and rate
        that replace laws; `forces` are functions of the states of bodies. Each has its name.
        """
    def simulate_into(self, /, directory: str | PathLike[str], options: Incomplete, choices: SupportsGetItem[int, str], until: SupportsFloat | SupportsIndex | None, drives: SupportsGetItem[int, tuple[str, Any]], forces: SupportsGetItem[int, tuple[str, Any]], controller: Any | None, start: tuple[SupportsFloat | SupportsIndex, SupportsGetItem[int, SupportsFloat | SupportsIndex], SupportsGetItem[int, SupportsFloat | SupportsIndex]] | None) -> str:
        """
        Runs the scene and writes the files of the command into a directory; returns the summary.
        With `until` the run ends at the row of this time (s), like a run that was requested to end
        there.
        """
    def started_text(self, /, t: SupportsFloat | SupportsIndex, q: SupportsGetItem[int, SupportsFloat | SupportsIndex], v: SupportsGetItem[int, SupportsFloat | SupportsIndex]) -> Scene:
        """
        Returns the text of the scene that starts at a time, coordinates and velocities.
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
class Simulator:
    """
    A run that is advanced step by step.
    """
    def __new__(cls, /, scene: Scene, options: Incomplete, start: tuple[SupportsFloat | SupportsIndex, SupportsGetItem[int, SupportsFloat | SupportsIndex], SupportsGetItem[int, SupportsFloat | SupportsIndex]] | None) -> Simulator:
        """
        Starts a run at the start of a scene, or at a time, coordinates and velocities.
        """
    def command(self, /, drive: str, effort: SupportsFloat | SupportsIndex) -> None:
        """
        Commands a drive by a law: its force or torque keeps this value until it is changed.
        """
    def commands(self, /) -> list[tuple[str, float]]:
        """
        The commanded drives with their values.
        """
    def evaluations(self, /) -> int:
        """
        The number of evaluations of accelerations by all steps since the last reset.
        """
    def reactions(self, /) -> tuple[str, list[list[tuple[str, float]]]]:
        """
        The verdicts at the current state as JSON, and all components of the reactions of each joint
        for the independent rows of the run, with their names.
        """
    def reset(self, /, t: SupportsFloat | SupportsIndex, q: SupportsGetItem[int, SupportsFloat | SupportsIndex], v: SupportsGetItem[int, SupportsFloat | SupportsIndex]) -> None:
        """
        Continues at another time (s), with other coordinates and velocities.
        """
    def state(self, /) -> tuple[float, Incomplete, Incomplete]:
        """
        The time (s), the coordinates and the velocities.
        """
    def step(self, /, to: SupportsFloat | SupportsIndex) -> list[str]:
        """
        Advances the run to a time (s). Returns the events of the step as JSON.
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
