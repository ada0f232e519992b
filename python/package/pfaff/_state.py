"""The state of a mechanism, and functions of the whole state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments as arguments
from . import _pfaff
from ._errors import unknown, wrong, wrong_type
from ._functions import BodyState

Array = NDArray[np.float64]


class State:
    """Time, coordinates and velocities of a mechanism.

    The coordinates of a body are the position of its centre of mass, and its angle in the plane or
    the quaternion of its principal axes in space. If the scene has joint coordinates that count
    revolutions, these angles follow, and then the states of force laws. The velocities of a body are the velocity of its centre of
    mass in ground axes, and its angular velocity, in space in its principal axes. ``words()``
    describes each number.
    """

    __slots__ = ("_drives", "_measures", "_of", "q", "t", "v")

    def __init__(
        self, of: _pfaff.Kinematics, t: float, q: Array, v: Array, drives: Any = None
    ) -> None:
        self._of, self._drives = of, drives
        self._measures: list[list[float]] | None = None
        self.t = t
        """Time (s)."""
        self.q = q
        """Coordinates."""
        self.v = v
        """Velocities."""

    @property
    def bodies(self) -> Mapping[str, BodyState]:
        """The states of the centres of mass of the bodies, by their names."""
        return _Bodies(self)

    @property
    def coordinates(self) -> dict[str, float]:
        """The joint coordinates (m, rad) of drives by laws and of springs, by their names."""
        return {name: value for name, (value, _) in self._all_drives()}

    @property
    def rates(self) -> dict[str, float]:
        """The rates of :attr:`coordinates`."""
        return {name: rate for name, (_, rate) in self._all_drives()}

    @property
    def measures(self) -> dict[str, float]:
        """The measures of the scene, by their names."""
        return {name: value for name, (value, _) in self._all_measures()}

    @property
    def measure_rates(self) -> dict[str, float]:
        """The rates of :attr:`measures`."""
        return {name: rate for name, (_, rate) in self._all_measures()}

    def words(self) -> tuple[list[str], list[str]]:
        """Returns what each coordinate and each velocity is."""
        q, v = self._of.words()
        return q, v

    def _all_drives(self) -> Iterator[tuple[str, Any]]:
        if self._drives is None:
            self._drives = self._of.coordinates(self.t, list(self.q), list(self.v))
        return iter(zip(self._of.names()[1], self._drives, strict=True))

    def _all_measures(self) -> Iterator[tuple[str, Any]]:
        if self._measures is None:
            self._measures = self._of.measures(list(self.q), list(self.v))
        return iter(zip(self._of.names()[2], self._measures, strict=True))

    def __repr__(self) -> str:
        return f"<pfaff.State at t = {self.t} s, {len(self.q)} coordinates>"


class _Bodies(Mapping[str, BodyState]):
    """The states of bodies, computed on request."""

    __slots__ = ("_names", "_state")

    def __init__(self, state: State) -> None:
        self._state, self._names = state, state._of.names()[0]

    def __getitem__(self, name: str) -> BodyState:
        if name not in self._names:
            raise unknown("body", name, self._names)
        state = self._state
        of = state._of.body(self._names.index(name), list(state.q), list(state.v))
        return BodyState(*of[1:])

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


Controller = Callable[[float, State], Mapping[str, ArrayLike]]
"""Values of drives and loads of bodies, as a function of the time (s) and of the whole state.

The function returns a dictionary. A drive by a law has a force (N) or torque (N·m), and a body has
force and torque on its centre of mass in ground axes: ``[fx, fy, torque]`` in the plane, ``[fx, fy,
fz, tx, ty, tz]`` in space. Every call returns the same names.
"""


def of_controller(controller: Any, of: Callable[[], _pfaff.Kinematics]) -> Any:
    """Returns the function that a run calls with time, coordinates and velocities."""
    if controller is None:
        return None
    function = arguments.function("controller", controller, "t and the state")
    kinematics = of()

    def called(t: float, q: Array, v: Array, drives: Any) -> tuple[list[str], list[Any]]:
        found = function(t, State(kinematics, t, q, v, drives))
        if not isinstance(found, Mapping):
            raise wrong_type("the result of the controller", found, "a dictionary")
        return list(found), list(found.values())

    return called


StartArgument = State | tuple[float, ArrayLike, ArrayLike]


def of_start(start: Any) -> tuple[float, list[float], list[float]] | None:
    """Returns time, coordinates and velocities at which a run starts."""
    if start is None:
        return None
    if isinstance(start, State):
        return start.t, list(map(float, start.q)), list(map(float, start.v))
    try:
        t, q, v = start
    except (TypeError, ValueError):
        raise wrong_type("start", start, "a State, or (t, q, v)") from None
    return arguments.finite("t", t), _numbers("q", q), _numbers("v", v)


def _numbers(name: str, given: Any) -> list[float]:
    found = np.asarray(given, dtype=float)
    if found.ndim != 1:
        raise wrong(f"{name} has the shape {found.shape}, need one dimension")
    numbers: list[float] = found.tolist()
    return numbers


class ReactionNumber(NamedTuple):
    """A component of a reaction at one instant."""

    value: float
    """The value (N, N·m); NaN if the model does not determine it."""
    verdict: str
    """``"unique"``, ``"not_unique"`` or ``"undecided"``."""
