"""Python functions as laws of drives and as forces on bodies."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments as arguments

Array = NDArray[np.float64]
DriveLaw = Callable[[float, float, float], float]
"""Force (N) or torque (N·m) of a drive.

The arguments are the time (s), the joint coordinate (m or rad) and its rate.
"""


class BodyState(NamedTuple):
    """The state of the centre of mass of a body, in ground axes."""

    position: Array
    """Position of the centre of mass (m), 2 or 3 components."""
    rotation: Array
    """Rotation matrix from the frame of the body to ground axes, 2 × 2 or 3 × 3."""
    angle: float
    """Angle in the plane (rad), not reduced to one revolution; NaN in space."""
    velocity: Array
    """Velocity of the centre of mass (m/s), 2 or 3 components."""
    angular_velocity: Any
    """Angular velocity (rad/s): a scalar in the plane, 3 components in space."""


BodyForce = Callable[[float, BodyState], ArrayLike]
"""Force (N) and torque (N·m) on a body, as a function of time (s) and of its state.

The function returns ``[fx, fy, torque]`` in the plane and ``[fx, fy, fz, tx, ty, tz]`` in space.
The components are in ground axes, and the force acts at the centre of mass.
"""

Named = list[tuple[str, Callable[..., Any]]]


def of_drives(drives: Mapping[str, DriveLaw] | None) -> Named:
    """Returns names and functions of drives."""
    return _checked("drives", drives, "t, measure and rate")


def of_bodies(forces: Mapping[str, BodyForce] | None) -> Named:
    """Returns names of bodies, and their functions with scalars and arrays as arguments."""
    return [(body, _of_state(f)) for body, f in _checked("forces", forces, "t and the body")]


def _checked(option: str, functions: Mapping[str, Any] | None, needs: str) -> Named:
    def check(name: str, given: Any) -> Callable[..., Any]:
        return arguments.function(name, given, needs)

    given = {} if functions is None else functions
    return list(arguments.named(option, given, check, "functions by name").items())


def _of_state(function: BodyForce) -> Callable[..., ArrayLike]:
    def called(t: float, *state: Any) -> ArrayLike:
        return function(t, BodyState(*state))

    return called
