"""The input of an engine: bodies, joints, a start, and the instants of comparison.

All frames are at the centres of mass and parallel to the ground at the start, so that all engines
get the same values and do not have to rotate tensors. Units: m, kg, s, rad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GROUND = -1


@dataclass(frozen=True)
class Body:
    """A rigid body; its tensor about its centre of mass has ground axes at the start."""

    name: str
    mass: float
    centre: Array
    tensor: Array
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    angular_velocity: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True)
class Joint:
    """A joint of two bodies, with its position at the start.

    `kind` is revolute, spherical, prismatic or universal. For a revolute or prismatic joint, `axis`
    is its axis; for a universal joint, `axis` is fixed in the first body and `cross` in the second.
    For a ball joint, `axis` is the axis of a fast spin, for engines that describe ball joints by
    three angles. `closes` marks joints outside the spanning tree. If a user removes redundant rows
    of a closing joint by hand, `rows` are the rows to keep (x, y, z, then rotations about x, y, z,
    in a frame whose z is the axis).
    """

    name: str
    kind: str
    first: int
    second: int
    at: Array
    axis: Array | None = None
    cross: Array | None = None
    closes: bool = False
    rows: tuple[int, ...] = (1, 1, 1, 1, 1, 0)


Reference = Callable[[Array], Array]

Watched = tuple[int, Array]
"""A body and a point of it, from the centre of mass, in the axes of the body."""


@dataclass(frozen=True)
class Mechanism:
    """A scene; `reference(times)` returns the `watched` positions, (times, watched, 3)."""

    name: str
    bodies: list[Body]
    joints: list[Joint]
    gravity: Array
    duration: float
    watched: list[Watched]
    reference: Reference
    planar: bool = False
    samples: int = 20

    @property
    def times(self) -> Array:
        """Returns the instants of comparison, without the start."""
        return np.linspace(0.0, self.duration, self.samples + 1)[1:]

    @property
    def interval(self) -> float:
        """Returns the time between two instants of comparison."""
        return self.duration / self.samples

    def tree_joints(self) -> list[Joint]:
        """Returns the joints of the spanning tree, each after the joint of its first body."""
        return [joint for joint in self.joints if not joint.closes]

    def closing_joints(self) -> list[Joint]:
        """Returns the joints that close loops."""
        return [joint for joint in self.joints if joint.closes]

    def floating_bodies(self) -> list[int]:
        """Returns the bodies that have no joint in the tree."""
        carried = {joint.second for joint in self.tree_joints()}
        return [k for k in range(len(self.bodies)) if k not in carried]

    def centre(self, body: int) -> Array:
        """Returns the centre of mass at the start; the origin for the ground."""
        return np.zeros(3) if body == GROUND else self.bodies[body].centre

    def twist(self, body: int) -> tuple[Array, Array]:
        """Returns the velocity of the centre of mass and the angular velocity at the start."""
        if body == GROUND:
            return np.zeros(3), np.zeros(3)
        return self.bodies[body].velocity, self.bodies[body].angular_velocity

    def relative_spin(self, joint: Joint) -> Array:
        """Returns the angular velocity of the second body relative to the first at the start."""
        return self.twist(joint.second)[1] - self.twist(joint.first)[1]

    def sliding_rate(self, joint: Joint) -> float:
        """Returns the rate of a prismatic joint at the start."""
        velocities = []
        for body in (joint.first, joint.second):
            velocity, spin = self.twist(body)
            velocities.append(velocity + np.cross(spin, joint.at - self.centre(body)))
        return float(joint.axis @ (velocities[1] - velocities[0]))

    def error(self, places: Array) -> float:
        """Returns the largest distance of a watched point from the reference."""
        if len(places) == 0 or not np.isfinite(places).all():
            return float("nan")
        wanted = self.reference(self.times[: len(places)])
        return float(np.linalg.norm(places - wanted, axis=2).max())


def unit(vector: list[float] | Array) -> Array:
    """Returns the vector, scaled to length one."""
    vector = np.asarray(vector, float)
    return vector / np.linalg.norm(vector)


def second_axes(joint: Joint) -> tuple[Array, Array]:
    """Returns the axes of a universal joint at the start, in the first and in the second body."""
    return joint.axis, joint.cross


def perpendicular(axis: Array) -> tuple[Array, Array]:
    """Returns two unit vectors that complete the axis to a right-handed frame (u, v, axis)."""
    least = np.eye(3)[int(np.argmin(np.abs(axis)))]
    u = unit(least - (least @ axis) * axis)
    return u, np.cross(axis, u)
