"""A run: motion and reactions as arrays."""

from __future__ import annotations

import json
import os
import pickle
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _arguments as arguments
from . import _pfaff
from ._errors import ComputationError, unknown, wrong
from ._state import State

if TYPE_CHECKING:
    from ._scene import Scene

Array = NDArray[np.float64]

INTERRUPTED = "P0008"
"""Code of a run that a callback or a signal has ended."""

_SAME_TIME = 1e-12
"""Relative difference of times that differ only by rounding."""


@dataclass(frozen=True)
class Event:
    """An event during a run."""

    time: float
    """Time (s)."""
    kind: str
    """Kind of the event, such as ``singular-passage`` or ``impulse``."""
    redundancy_before: int
    """Degree of redundancy before the event."""
    redundancy_after: int
    """Degree of redundancy after the event."""
    deleted_rows: Sequence[int]
    """Rows without multiplier after the event (1-based)."""
    text: str
    """Description."""
    impulses: dict[str, Any] = field(default_factory=dict)
    """Impulses at a jump of velocities, by joint or drive.

    Each entry is ``{"components": {NAME: {"value", "verdict"}}}`` (N·s, N·m·s). Values that are not
    unique at this instant are ``None``.
    """


class _Columns:
    """Columns of a table that belong to one object. All arrays are views of the table."""

    __slots__ = ("_numbers", "_table", "name")

    def __init__(self, name: str, table: Array, numbers: dict[str, int]) -> None:
        self.name = name
        """Name of the object."""
        self._table = table
        self._numbers = numbers

    @property
    def columns(self) -> list[str]:
        """The names of the columns, as in the tables of the command."""
        return list(self._numbers)

    def __getitem__(self, column: str) -> Array:
        """Returns the values of one column."""
        if column not in self._numbers:
            raise unknown(f"number of `{self.name}`", column, self._numbers)
        return self._table[:, self._numbers[column]]

    def _of(self, columns: Sequence[str]) -> Array:
        places = [self._numbers[column] for column in columns if column in self._numbers]
        if not places:
            raise unknown(f"number of `{self.name}`", columns[0], self._numbers)
        return self._table[:, places[0] : places[-1] + 1]


_C = TypeVar("_C", bound=_Columns)


class BodyMotion(_Columns):
    """The motion of a body or a marker: the motion of the origin of its frame, in ground axes."""

    __slots__ = ()

    @property
    def position(self) -> Array:
        """Positions (m), 2 or 3 columns."""
        return self._of(("x", "y", "z"))

    @property
    def angle(self) -> Array:
        """Angles in the plane (rad), not reduced to one revolution."""
        return self["angle"]

    @property
    def orientation(self) -> Array:
        """Quaternions in space, the real part first."""
        return self._of(("qw", "qx", "qy", "qz"))

    @property
    def velocity(self) -> Array:
        """Velocities (m/s), 2 or 3 columns."""
        return self._of(("vx", "vy", "vz"))

    @property
    def angular_velocity(self) -> Array:
        """Angular velocities (rad/s): one value per time in the plane, 3 columns in space."""
        return self["omega"] if "omega" in self._numbers else self._of(("wx", "wy", "wz"))

    @property
    def acceleration(self) -> Array:
        """Accelerations (m/s²), 2 or 3 columns; ``[output]`` needs ``accelerations = true``."""
        return self._of(("ax", "ay", "az"))

    @property
    def angular_acceleration(self) -> Array:
        """Angular accelerations (rad/s²), in columns like the angular velocities.

        The table ``[output]`` needs ``accelerations = true``.
        """
        return self["alpha"] if "alpha" in self._numbers else self._of(("alphax", "alphay", "alphaz"))


class Reaction(_Columns):
    """The reaction of a joint or drive, on its first body and in ground axes.

    Torques are about the reference point.
    """

    __slots__ = ()

    @property
    def force(self) -> Array:
        """Forces (N), 2 or 3 columns; NaN between two events if the force is not determined."""
        return self._of(("Fx", "Fy", "Fz"))

    @property
    def torque(self) -> Array:
        """Torques (N·m): one value per time in the plane, 3 columns in space; NaN as for forces."""
        return self["T"] if "T" in self._numbers else self._of(("Tx", "Ty", "Tz"))


class Load(_Columns):
    """The load of a force element on its first body, in ground axes.

    Torques are about the point of the element on this body. The model determines these loads.
    """

    __slots__ = ()

    @property
    def force(self) -> Array:
        """Forces (N), 2 or 3 columns."""
        return self._of(("Fx", "Fy", "Fz"))

    @property
    def torque(self) -> Array:
        """Torques (N·m): one value per time in the plane, 3 columns in space."""
        return self["T"] if "T" in self._numbers else self._of(("Tx", "Ty", "Tz"))

    @property
    def length(self) -> Array:
        """Lengths (m) of an element between two points."""
        return self["length"]

    @property
    def angle(self) -> Array:
        """Angles (rad) of an element between two directions."""
        return self["angle"]

    @property
    def rate(self) -> Array:
        """Rates of the length (m/s) or of the angle (rad/s)."""
        return self["rate"]


class ChosenReactions:
    """Reactions of a run for one choice.

    Components that the model determines have their values; the choice selects one solution for the
    other components.
    """

    def __init__(self, name: str, reactions: Array, columns: Sequence[tuple[str, str, str]]) -> None:
        self.name = name
        """The name of the choice."""
        self.reactions: Array = reactions
        """The columns of ``choice.csv`` after ``t``; NaN if the choice selects no solution."""
        self._seal()
        self._reactions = _grouped(columns, reactions, Reaction, ("reaction",))
        self._groups = _grouped(columns, reactions, _Columns, ("group",))

    def _seal(self) -> None:
        self.reactions.flags.writeable = False

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._seal()

    def reaction(self, name: str) -> Reaction:
        """Returns the reaction of a joint or drive."""
        return _named("joint or drive", name, self._reactions)

    def group(self, name: str) -> _Columns:
        """Returns the values of a group of the scene."""
        return _named("group with numbers", name, self._groups)

    def __repr__(self) -> str:
        return f"<pfaff.ChosenReactions: {self.name}>"


class Run:
    """A run with its rows. Arrays have one row for each time and are read-only."""

    def __init__(
        self, of: _pfaff.Run, scene: Scene, options: dict[str, Any], is_chosen: bool = False
    ) -> None:
        self._options = options
        self._missing: list[str] = []
        (trajectory, columns), (reactions, of_reactions), (loads, of_loads) = of.tables()
        self.choices: list[ChosenReactions] = [
            ChosenReactions(name, numbers, of_reactions) for name, numbers in of.chosen()
        ]
        """The values for each choice of ``choose``, in its order; empty if rows are deleted."""
        self.scene = scene
        """The scene that was run."""
        self.t: Array = of.t
        """Times (s)."""
        self.q: Array = of.q
        """Coordinates."""
        self.v: Array = of.v
        """Velocities."""
        self.trajectory: Array = trajectory
        """The columns of ``trajectory.csv`` after ``t``."""
        self.reactions: Array = self.choices[0].reactions if is_chosen else reactions
        """The columns of ``reactions.csv`` after ``t``.

        Empty cells are NaN. With a single choice, the table contains the values of this choice.
        """
        self.loads: Array = loads
        """The columns of ``loads.csv`` after ``t``."""
        lowest, highest = of.bounds()
        has_bounds = lowest.shape[1] > 0
        self.lowest: ChosenReactions | None = (
            ChosenReactions("lowest", lowest, of_reactions) if has_bounds else None
        )
        """The lowest values for joints of any stiffness; ``None`` without bounds."""
        self.highest: ChosenReactions | None = (
            ChosenReactions("highest", highest, of_reactions) if has_bounds else None
        )
        """The highest values for joints of any stiffness; ``None`` without bounds."""
        self._seal()
        self.document: dict[str, Any] = json.loads(of.document)
        """The summary, as in ``summary.json``."""
        self.columns: list[str] = [_heading(owner, number) for _, owner, number in columns]
        """Names of the columns of :attr:`trajectory`."""
        self.reaction_columns: list[str] = of.reaction_names
        """Names of the columns of :attr:`reactions`."""
        headings = [_heading(owner, number) for _, owner, number in of_loads]
        self.load_columns: list[str] = headings
        """Names of the columns of :attr:`loads`."""
        self._loads = _grouped(of_loads, self.loads, Load, ("force",))
        self._bodies = _grouped(columns, self.trajectory, BodyMotion, ("body",))
        self._markers = _grouped(columns, self.trajectory, BodyMotion, ("marker",))
        self._others = _grouped(columns, self.trajectory, _Columns, ("measure", "law"))
        self._reactions = _grouped(of_reactions, self.reactions, Reaction, ("reaction",))
        self._groups = _grouped(of_reactions, self.reactions, _Columns, ("group",))

    def _seal(self) -> None:
        for array in (self.t, self.q, self.v, self.trajectory, self.reactions, self.loads):
            array.flags.writeable = False

    def __getstate__(self) -> dict[str, Any]:
        options = dict(self._options)
        missing = [name for name in _FUNCTIONS if not _can_pickle(options.get(name))]
        options.update(dict.fromkeys(missing))
        return {**self.__dict__, "_options": options, "_missing": [*self._missing, *missing]}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._seal()

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies."""
        return list(self._bodies)

    @property
    def markers(self) -> list[str]:
        """Names of the markers that can move."""
        return list(self._markers)

    @property
    def measures(self) -> list[str]:
        """Names of joint coordinates (measures), and of drives with laws."""
        return list(self._others)

    @property
    def joints(self) -> list[str]:
        """Names of joints and drives."""
        return list(self._reactions)

    @property
    def partial(self) -> bool:
        """Whether the run ended before its end time."""
        partial: bool = self.document["partial"]
        return partial

    @property
    def events(self) -> list[Event]:
        """Events of the run."""
        return [Event(**event) for event in self.document["events"]]

    def body(self, name: str) -> BodyMotion:
        """Returns the motion of a body."""
        return _named("body", name, self._bodies)

    def marker(self, name: str) -> BodyMotion:
        """Returns the motion of a marker."""
        return _named("marker", name, self._markers)

    def measure(self, name: str, number: str = "") -> Array:
        """Returns a joint coordinate, or the force or torque (N, N·m) of a drive law.

        With ``accelerations = true`` in ``[output]``, ``number`` may be ``"rate"`` or
        ``"acceleration"``. These numbers are the derivatives of a measure.
        """
        of = _named("measure", name, self._others)
        return of[number or of.columns[0]]

    def reaction(self, name: str) -> Reaction:
        """Returns the reaction of a joint or drive."""
        return _named("joint or drive", name, self._reactions)

    @property
    def forces(self) -> list[str]:
        """Names of force elements, and of drives with laws."""
        return list(self._loads)

    def load(self, name: str) -> Load:
        """Returns the load of a force element or of a drive with a law."""
        return _named("force", name, self._loads)

    def group(self, name: str) -> _Columns:
        """Returns the values of a group of the scene; NaN for values that are not determined."""
        return _named("group with numbers", name, self._groups)

    def state(self, row: int) -> State:
        """Returns the state of a row, counted from 0; negative numbers count from the end."""
        kinematics = self.scene._of.kinematics()
        return State(kinematics, float(self.t[row]), self.q[row], self.v[row])

    def scene_at(self, t: float) -> Scene:
        """Returns the scene that starts at a row of this run, given by its time (s).

        The run of this scene is the rest of the motion: prescribed motions continue.
        """
        wanted = arguments.finite("t", t)
        row = int(np.argmin(np.abs(self.t - wanted)))
        nearest = float(self.t[row])
        if abs(nearest - wanted) > _SAME_TIME * max(1.0, abs(wanted)):
            raise wrong(f"t is {wanted}, and no row has this time; the nearest row is at {nearest}")
        return self.scene.starting_at(self.state(row))

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes the page of this run for any browser.

        The run is repeated with additional rows for the animation. The repeated run ends at the
        same time, even if the run stopped or a callback ended it. The functions of drives and
        bodies are called again.
        """
        if self._missing:
            names = " and ".join(f"`{name}`" for name in self._missing)
            raise wrong(
                f"the page repeats the run, and {names} could not be pickled with it: run the scene again"
            )
        stopped = self.document["code"] not in (None, INTERRUPTED)
        until = float(self.t[-1]) if self.partial and not stopped else None
        try:
            self.scene._page(path, self._options, until)
        except ComputationError:
            if not stopped:
                raise

    def to_pandas(self) -> Any:
        """Returns all columns as a ``pandas.DataFrame`` with the times as its index."""
        import pandas

        index = pandas.Index(self.t, name="t")
        table = np.hstack((self.trajectory, self.reactions, self.loads))
        columns = self.columns + self.reaction_columns + self.load_columns
        return pandas.DataFrame(table, index=index, columns=columns)

    def to_polars(self) -> Any:
        """Returns all columns as a ``polars.DataFrame``; the first column is ``t``."""
        import polars

        table = np.column_stack((self.t, self.trajectory, self.reactions, self.loads))
        schema = ["t", *self.columns, *self.reaction_columns, *self.load_columns]
        return polars.from_numpy(table, schema=schema, orient="row")

    def plot(self, *columns: str, ax: Any = None) -> Any:
        """Plots columns against time, by their names in the tables; returns the axes.

        By default, the positions of all bodies are plotted. This method needs matplotlib.
        """
        wanted: Iterable[str] = columns or [
            heading for heading in self.columns if heading.endswith((".x", ".y", ".z"))
        ]
        lines = [(heading, self._column(heading)) for heading in wanted]
        if ax is None:
            from matplotlib import pyplot

            _, ax = pyplot.subplots()
        for heading, values in lines:
            ax.plot(self.t, values, label=heading)
        ax.set_xlabel("t (s)")
        ax.legend()
        return ax

    def _column(self, heading: str) -> Array:
        for headings, table in (
            (self.columns, self.trajectory),
            (self.reaction_columns, self.reactions),
            (self.load_columns, self.loads),
        ):
            if heading in headings:
                return table[:, headings.index(heading)]
        raise unknown("column", heading, [*self.columns, *self.reaction_columns])

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        end = float(self.t[-1]) if len(self.t) else 0.0
        return f"<pfaff.Run to t = {end} s, {len(self.t)} rows>"

    def _repr_html_(self) -> str:
        return f"<p>{len(self.t)} rows</p>{self.scene._repr_html_()}"


_FUNCTIONS = ("drives", "forces", "controller")
"""Options of a run that may contain functions."""


def _can_pickle(option: Any) -> bool:
    try:
        pickle.dumps(option)
    except (pickle.PicklingError, AttributeError, TypeError):
        return False
    return True


def _heading(owner: str, number: str) -> str:
    return f"{owner}.{number}" if number else owner


def _grouped(
    columns: Iterable[tuple[str, str, str]], table: Array, made: type[_C], kinds: Sequence[str]
) -> dict[str, _C]:
    groups: dict[str, dict[str, int]] = {}
    for place, (kind, owner, number) in enumerate(columns):
        if kind in kinds:
            groups.setdefault(owner, {})[number] = place
    return {owner: made(owner, table, numbers) for owner, numbers in groups.items()}


def _named(what: str, name: str, known: dict[str, _C]) -> _C:
    if name not in known:
        raise unknown(what, name, known)
    return known[name]
