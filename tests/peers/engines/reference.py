"""Exact motions of the scenes, each from an equation for one coordinate or from a closed form.

No part of this file uses a measured program. A mechanism of one degree of freedom has the kinetic
energy m(s)·s'²/2 and the potential V(s) in one coordinate s, hence m·s'' + m'·s'²/2 + V' = 0. Poses
are computed at Chebyshev points, and their polynomials are differentiated exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import chebyshev
from scipy.integrate import solve_ivp

from mechanism import Array, Body, Reference, Watched

TOLERANCES = {"rtol": 1e-13, "atol": 1e-14, "method": "DOP853"}

Pose = tuple[Array, Array]
"""Centres of mass (bodies, 3) and rotation matrices (bodies, 3, 3)."""


def solution(slope: Callable, start: list[float], times: Array) -> Array:
    """Returns the values at the times, (times, components)."""
    run = solve_ivp(slope, (0.0, times[-1]), start, t_eval=times, **TOLERANCES)
    assert run.success and run.y.shape[1] == len(times), run.message
    return run.y.T


@dataclass(frozen=True)
class OneFreedom:
    """A mechanism whose pose is a function of one coordinate within an interval."""

    bodies: list[Body]
    gravity: Array
    pose: Callable[[float], Pose]
    interval: tuple[float, float]
    start: tuple[float, float]
    degree: int = 160

    def tabulated(self) -> tuple[Array, Array]:
        """Returns coefficients of centres and rotations; the first index is the degree."""
        low, high = self.interval
        points = chebyshev.chebpts1(self.degree + 1)
        places = 0.5 * (low + high) + 0.5 * (high - low) * points
        outwards = np.argsort(np.abs(places - self.start[0]))
        poses = {k: self.pose(places[k]) for k in outwards}
        in_order = [poses[k] for k in range(len(points))]
        centres = np.array([pose[0] for pose in in_order])
        turns = np.array([pose[1] for pose in in_order])
        return self.fitted(centres), self.fitted(turns)

    def fitted(self, values: Array) -> Array:
        """Returns Chebyshev coefficients of values at the points; the coefficients must decay."""
        points = chebyshev.chebpts1(self.degree + 1)
        table = values.reshape(len(points), -1)
        weights = 2.0 / len(points) * chebyshev.chebvander(points, self.degree).T
        weights[0] *= 0.5
        series = weights @ table
        tail = np.abs(series[-4:]).max() / max(1.0, np.abs(series).max())
        assert tail < 1e-11, f"the poses are not resolved: {tail:.1e}"
        return series

    def energies(self, centres: Array, turns: Array) -> tuple[Array, Array]:
        """Returns the series of the inertia m(s) and of the potential V(s)."""
        low, high = self.interval
        scale = 2.0 / (high - low)
        points = chebyshev.chebpts1(self.degree + 1)
        count = len(self.bodies)
        masses = np.array([body.mass for body in self.bodies])
        tensors = np.array([body.tensor for body in self.bodies])

        def values(series: Array) -> Array:
            return chebyshev.chebvander(points, len(series) - 1) @ series

        moved = scale * values(chebyshev.chebder(centres)).reshape(-1, count, 3)
        turn = values(turns).reshape(-1, count, 3, 3)
        change = scale * values(chebyshev.chebder(turns)).reshape(-1, count, 3, 3)
        skew = np.einsum("pbji,pbjk->pbik", turn, change)
        spin = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
        inertia = np.einsum("b,pbi,pbi->p", masses, moved, moved)
        inertia += np.einsum("pbi,bij,pbj->p", spin, tensors, spin)
        place = values(centres).reshape(-1, count, 3)
        potential = -np.einsum("b,pbi,i->p", masses, place, self.gravity)
        return self.fitted(inertia)[:, 0], self.fitted(potential)[:, 0]

    def reference(self, watched: list[Watched]) -> Reference:
        """Returns the motion from the start, as a function of the times."""
        low, high = self.interval
        scale = 2.0 / (high - low)
        centres, turns = self.tabulated()
        inertia, potential = self.energies(centres, turns)
        slopes = [np.r_[chebyshev.chebder(series), 0.0] for series in (inertia, potential)]
        series = np.stack([inertia, scale * slopes[0], scale * slopes[1]], axis=1)
        orders = np.arange(self.degree + 1)
        count = len(self.bodies)

        def at(table: Array, s: float) -> Array:
            assert low < s < high, f"the coordinate {s} leaves [{low}, {high}]"
            return np.cos(orders * np.arccos(scale * (s - low) - 1.0)) @ table

        def slope(_: float, state: Array) -> list[float]:
            m, m1, v1 = at(series, state[0])
            return [state[1], -(0.5 * m1 * state[1] ** 2 + v1) / m]

        def places(times: Array) -> Array:
            rows = []
            for s in solution(slope, list(self.start), times)[:, 0]:
                middle = at(centres, s).reshape(count, 3)
                turn = at(turns, s).reshape(count, 3, 3)
                rows.append([middle[body] + turn[body] @ offset for body, offset in watched])
            return np.array(rows)

        return places


def turned(axis: Array, angle: float) -> Array:
    """Returns the rotation matrix about a unit axis."""
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * skew @ skew


@dataclass
class ClosedChain:
    """A single loop of hinges: its pose from the angle of the first hinge, by Newton's method.

    `points` and `axes` belong to the hinges at the start, from ground to ground; the last hinge
    closes the loop. The loop is overconstrained, so Newton's equations are solved by least squares;
    they are consistent along the motion.
    """

    points: Array
    axes: Array
    centres: Array
    known: dict[float, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Stores the pose of the start."""
        self.known[0.0] = np.zeros(len(self.points) - 1)

    def placed(self, angles: Array) -> tuple[list[Array], list[Array]]:
        """Returns rotation and displacement of each link: x ↦ R·x + d for a point at the start."""
        turn, shift = np.eye(3), np.zeros(3)
        turns, shifts = [], []
        for angle, point, axis in zip(angles, self.points, self.axes, strict=False):
            own = turned(axis, angle)
            shift = turn @ (point - own @ point) + shift
            turn = turn @ own
            turns.append(turn)
            shifts.append(shift)
        return turns, shifts

    def misfit(self, angles: Array) -> Array:
        """Returns six values that are zero if the last hinge is closed: position and axis."""
        turns, shifts = self.placed(angles)
        point, axis = self.points[-1], self.axes[-1]
        return np.r_[turns[-1] @ point + shifts[-1] - point, np.cross(turns[-1] @ axis, axis)]

    def jacobian(self, angles: Array) -> Array:
        """Returns the derivatives of the violation with respect to the angles after the first."""
        turns, shifts = self.placed(angles)
        point, axis = self.points[-1], self.axes[-1]
        place, direction = turns[-1] @ point + shifts[-1], turns[-1] @ axis
        columns = []
        for k in range(1, len(angles)):
            along = turns[k] @ self.axes[k]
            origin = turns[k] @ self.points[k] + shifts[k]
            columns.append(
                np.r_[np.cross(along, place - origin), np.cross(np.cross(along, direction), axis)]
            )
        return np.array(columns).T

    def closed(self, guess: Array) -> Array:
        """Returns the angles for the given first angle, closed to rounding."""
        angles = guess.copy()
        for _ in range(30):
            step = np.linalg.lstsq(self.jacobian(angles), -self.misfit(angles), rcond=1e-9)[0]
            angles[1:] += step
            if np.abs(step).max() < 1e-14:
                break
        assert np.abs(self.misfit(angles)).max() < 1e-12, "the loop does not close"
        return angles

    def pose(self, first: float) -> Pose:
        """Returns centres and rotations for an angle of the first hinge."""
        nearest = min(self.known, key=lambda angle: abs(angle - first))
        angles = self.known[nearest].copy()
        steps = max(1, int(np.ceil(abs(first - nearest) / 0.05)))
        for k in range(1, steps + 1):
            angles[0] = nearest + (first - nearest) * k / steps
            angles = self.closed(angles)
        self.known[first] = angles
        turns, shifts = self.placed(angles)
        links = zip(turns, shifts, self.centres, strict=True)
        return np.array([r @ c + d for r, d, c in links]), np.array(turns)


def pendulum_of_bars(count: int, speed: float) -> Callable[[Array], Array]:
    """Returns the angle of the uprights of the n-four-bar from the upward vertical, clockwise.

    All uprights are parallel, and all couplers translate, so that
    [(n + 1)/3 + n]·a'' = [(n + 1)/2 + n]·g·sin a; a(0) = 0, a'(0) = speed.
    """
    factor = 9.81 * ((count + 1) / 2 + count) / ((count + 1) / 3 + count)

    def angle(times: Array) -> Array:
        slope = lambda _, y: [y[1], factor * np.sin(y[0])]  # noqa: E731
        return solution(slope, [0.0, speed], times)[:, 0]

    return angle


def rigid_body(body: Body, gravity: Array, point: Array | None, offset: Array) -> Reference:
    """Returns positions of a point of one body, free or fixed at a point, by Euler's equations.

    `point` is the fixed point relative to the centre of mass at the start. If it is None, no force
    except the weight acts on the body.
    """
    arm = np.zeros(3) if point is None else -point
    tensor = body.tensor + (
        0.0 if point is None else body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    )
    inverse = np.linalg.inv(tensor)
    a, b, c = body.mass * arm
    lever = np.array([[0.0, -c, b], [c, 0.0, -a], [-b, a, 0.0]])

    def slope(_: float, state: Array) -> Array:
        turn, spin = state[:9].reshape(3, 3), state[9:]
        x, y, z = spin
        skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        rate = inverse @ (lever @ (turn.T @ gravity) - skew @ (tensor @ spin))
        return np.r_[(turn @ skew).ravel(), rate]

    def places(times: Array) -> Array:
        path = solution(slope, [*np.eye(3).ravel(), *body.angular_velocity], times)
        turns = path[:, :9].reshape(-1, 3, 3)
        fixed = body.centre - arm
        return (fixed + turns @ (arm + offset))[:, None, :]

    return places
