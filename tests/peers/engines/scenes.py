"""The scenes: the same values for every engine, and the exact motion of each scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mechanism import GROUND, Array, Body, Joint, Mechanism, Reference, Watched, unit
from reference import ClosedChain, OneFreedom, pendulum_of_bars, rigid_body, turned

G = 9.81
X, Y, Z = np.eye(3)
HERE = np.zeros(3)
NEARBY = 2e-3
"""Relative change of the start between neighbours of a scene."""


def rod_tensor(length: float, mass: float, along: Array) -> Array:
    """Returns the tensor of a rod with a cross section of 0.1 m × 0.1 m."""
    own = mass * 0.1**2 / 6.0
    across = mass * (length**2 + 0.1**2) / 12.0
    return across * np.eye(3) + (own - across) * np.outer(along, along)


def n_four_bar(
    count: int, nearby: int = 0, planar: bool = False, about_itself: float = 1.0 / 600.0
) -> Mechanism:
    """Returns n falling four-bars in a row: n + 1 uprights, n couplers, rods of 1 m and 1 kg.

    The motion passes singular configurations, at which it could change to another branch. In space
    all hinges are parallel to z, and 3 n rows are redundant. `about_itself` is the moment of
    inertia of a rod about its own axis, by default for 0.1 m × 0.1 m; the motion does not depend on
    it.
    """
    speed = 1.0 + NEARBY * nearby
    along = np.diag([1.0, 0.0, 1.0]) / 12.0
    across = np.diag([0.0, 1.0, 1.0]) / 12.0
    bodies, joints = [], []
    for k in range(count + 1):
        tensor = along + about_itself * np.diag([0.0, 1.0, 0.0])
        place, velocity = np.array([k, 0.5, 0.0]), np.array([0.5 * speed, 0.0, 0.0])
        bodies.append(Body(f"upright-{k}", 1.0, place, tensor, velocity, -speed * Z))
    for k in range(count):
        tensor = across + about_itself * np.diag([1.0, 0.0, 0.0])
        place, velocity = np.array([k + 0.5, 1.0, 0.0]), speed * X
        bodies.append(Body(f"rod-{k}", 1.0, place, tensor, velocity))
    for k in range(count + 1):
        joints.append(Joint(f"foot-{k}", "revolute", GROUND, k, np.array([k, 0.0, 0.0]), Z))
    for k in range(count):
        rod = count + 1 + k
        left, right = np.array([k, 1.0, 0.0]), np.array([k + 1.0, 1.0, 0.0])
        joints.append(Joint(f"left-{k}", "revolute", k, rod, left, Z))
        rows = (1, 1, 0, 0, 0, 0)
        joints.append(Joint(f"right-{k}", "revolute", k + 1, rod, right, Z, None, True, rows))
    angle = pendulum_of_bars(count, speed)

    def reference(times: Array) -> Array:
        a = angle(times)
        top = np.stack([np.sin(a), np.cos(a), 0.0 * a], axis=1)
        return np.stack([0.5 * top, count * X + 0.5 * top, (count - 0.5) * X + top], axis=1)

    watched = [(0, HERE), (count, HERE), (2 * count, HERE)]
    space = "plane" if planar else "space"
    return Mechanism(
        f"n-four-bar-{space}-{count}", bodies, joints, -G * Y, 5.0, watched, reference, planar
    )


def three_cranks(_: int = 1, nearby: int = 0, planar: bool = True) -> Mechanism:
    """Returns three parallel cranks with a coupler of 2 m, at rest at 60°: one redundant row."""
    start = np.deg2rad(60.0) + NEARBY * nearby
    top = np.array([np.cos(start), np.sin(start), 0.0])
    bodies, joints = [], []
    for k in range(3):
        tensor = rod_tensor(1.0, 1.0, top)
        bodies.append(Body(f"crank-{k}", 1.0, k * X + 0.5 * top, tensor))
        joints.append(Joint(f"foot-{k}", "revolute", GROUND, k, k * X, Z))
    bodies.append(Body("coupler", 2.0, X + top, rod_tensor(2.0, 2.0, X)))
    joints.append(Joint("top-0", "revolute", 0, 3, top, Z))
    for k, rows in ((1, (1, 1, 0, 0, 0, 0)), (2, (0, 1, 0, 0, 0, 0))):
        joints.append(Joint(f"top-{k}", "revolute", k, 3, k * X + top, Z, None, True, rows))
    crank = bodies[0].tensor[2, 2] + 0.25
    factor = (3 * 0.5 + 2.0) * G / (3 * crank + 2.0)

    def reference(times: Array) -> Array:
        from reference import solution

        a = solution(lambda _, y: [y[1], -factor * np.cos(y[0])], [start, 0.0], times)[:, 0]
        u = np.stack([np.cos(a), np.sin(a), 0.0 * a], axis=1)
        return np.stack([0.5 * u, X + u], axis=1)

    watched = [(0, HERE), (3, HERE)]
    name = "three-cranks-plane" if planar else "three-cranks-space"
    return Mechanism(name, bodies, joints, -G * Y, 1.2, watched, reference, planar)


def chain(
    name: str,
    points: list[list[float]],
    axes: list[list[float]],
    masses: list[float],
    rows: tuple[int, ...],
    motion: tuple[Array, float, float, tuple[float, float]],
) -> Mechanism:
    """Returns a loop of hinges between rods; `motion`: gravity, time, first rate, interval."""
    gravity, duration, rate, interval = motion
    places = np.array(points, float)
    directions = np.array([unit(axis) for axis in axes])
    centres = 0.5 * (places[:-1] + places[1:])
    solid = []
    for k, mass in enumerate(masses):
        rod = places[k + 1] - places[k]
        length = float(np.linalg.norm(rod))
        solid.append(Body(f"rod-{k}", mass, centres[k], rod_tensor(length, mass, rod / length)))
    loop = ClosedChain(places, directions, centres)
    exact = OneFreedom(solid, gravity, loop.pose, interval, (0.0, rate))
    bodies = [moving(body, loop, rate, k) for k, body in enumerate(solid)]
    joints = []
    for k in range(len(points)):
        closes = k == len(points) - 1
        first, second = k - 1, (GROUND if closes else k)
        # In every scene, the ground is the first body of a joint.
        first, second = (second, first) if closes else (first, second)
        joints.append(
            Joint(
                f"hinge-{k}",
                "revolute",
                first,
                second,
                places[k],
                directions[k],
                None,
                closes,
                rows,
            )
        )
    watched: list[Watched] = [(k, HERE) for k in range(len(bodies))]
    return Mechanism(name, bodies, joints, gravity, duration, watched, exact.reference(watched))


def moving(body: Body, loop: ClosedChain, rate: float, k: int) -> Body:
    """Returns the body with its velocities for a rate of the first hinge."""
    angles = np.zeros(len(loop.points) - 1)
    jacobian = loop.jacobian(angles)
    first = first_column(loop)
    rates = np.r_[rate, np.linalg.lstsq(jacobian, -first * rate, rcond=1e-9)[0]]
    spin, velocity = np.zeros(3), np.zeros(3)
    for j in range(k + 1):
        spin = spin + rates[j] * loop.axes[j]
        velocity = velocity + rates[j] * np.cross(loop.axes[j], body.centre - loop.points[j])
    return Body(body.name, body.mass, body.centre, body.tensor, velocity, spin)


def first_column(loop: ClosedChain) -> Array:
    """Returns the derivative of the violation with respect to the first angle, at the start."""
    point, axis = loop.points[-1], loop.axes[-1]
    along, origin = loop.axes[0], loop.points[0]
    return np.r_[np.cross(along, point - origin), np.cross(np.cross(along, axis), axis)]


def bricard(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns Bricard's linkage, IFToMM A04: six hinges along edges of a cube, from rest; p = 1."""
    points = [[0, 0, 0], [1, 0, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1], [0, 0, 1]]
    axes = [[0, 1, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]]
    motion = (-G * Y, 1.0, NEARBY * nearby, (-0.35, 1.35))
    return chain("bricard", points, axes, [1.0] * 5, (1, 1, 1, 1, 0, 0), motion)


def bennett(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns Bennett's linkage with rational dimensions, swinging from rest; p = 3."""
    points = [[0, 0, 0], [0, 3, 0], [-16 / 13, -9 / 13, 12 / 13], [-4, 0, 0]]
    axes = [[0, 0, 1], [3, 0, 4], [-3, 4, 12], [0, 4, 3]]
    motion = (-G * Z, 2.0, NEARBY * nearby, (-2.5, 2.5))
    return chain("bennett", points, axes, [3.0, 4.0, 3.0], (1, 1, 0, 0, 0, 0), motion)


def slider_crank(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns a spatial slider-crank: hinge about x, rod between two balls, slide along x.

    The rod is thin and round. It starts without spin about its axis and keeps this spin, so that
    the positions do not depend on it. No row is redundant; the idle spin is a second degree of
    freedom.
    """
    crank, rod, height = 0.1, 0.3, 0.12
    speed = 12.0 * (1.0 + NEARBY * nearby)
    hub = np.array([0.0, 0.1, height])

    def ends(angle: float) -> tuple[Array, Array]:
        pin = hub + crank * np.array([0.0, np.cos(angle), np.sin(angle)])
        return pin, np.array([np.sqrt(rod**2 - pin[1] ** 2 - pin[2] ** 2), 0.0, 0.0])

    pin, slide = ends(0.0)
    along = unit(slide - pin)
    solid = [
        Body("crank", 0.12, hub + 0.5 * (pin - hub), rod_tensor(0.1, 0.12, Y)),
        Body("rod", 0.5, 0.5 * (pin + slide), 0.00375 * (np.eye(3) - 0.9 * np.outer(along, along))),
        Body("slider", 2.0, slide, 1e-4 * np.eye(3)),
    ]

    def pose(angle: float) -> tuple[Array, Array]:
        pin, slide = ends(angle)
        direction = (slide - pin) / rod
        cross = np.cross(along, direction)
        skew = np.array(
            [[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]]
        )
        least = np.eye(3) + skew + skew @ skew / (1.0 + along @ direction)
        return np.array([0.5 * (hub + pin), 0.5 * (pin + slide), slide]), np.array(
            [turned(X, angle), least, np.eye(3)]
        )

    # The solution of least rotation contains a spin of the rod about its axis, which affects its
    # energy for a round tensor. A tensor without a moment about the axis of the rod omits this
    # energy.
    thin = Body("rod", 0.5, solid[1].centre, 0.00375 * (np.eye(3) - np.outer(along, along)))
    exact = OneFreedom(
        [solid[0], thin, solid[2]], -G * Z, pose, (-0.5, 16.0), (0.0, speed), degree=400
    )
    pin_rate = speed * crank * Z
    slide_rate = -(pin[1:] @ pin_rate[1:]) / slide[0] * X
    spin = np.cross(along, slide_rate - pin_rate) / rod
    bodies = [
        Body("crank", 0.12, solid[0].centre, solid[0].tensor, 0.5 * pin_rate, speed * X),
        Body("rod", 0.5, solid[1].centre, solid[1].tensor, 0.5 * (pin_rate + slide_rate), spin),
        Body("slider", 2.0, slide, solid[2].tensor, slide_rate),
    ]
    joints = [
        Joint("hinge", "revolute", GROUND, 0, hub, X),
        Joint("ball", "spherical", 0, 1, pin),
        Joint("slide", "prismatic", GROUND, 2, slide, X),
        Joint("socket", "spherical", 1, 2, slide, None, None, True, (1, 1, 1, 0, 0, 0)),
    ]
    watched = [(0, HERE), (1, HERE), (2, HERE)]
    return Mechanism("slider-crank", bodies, joints, -G * Z, 1.0, watched, exact.reference(watched))


def top(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns a fast heavy top on a ball joint (15 kg, 150 rad/s), a standard test."""
    spin = np.array([0.0, 150.0, -4.61538 * (1.0 + NEARBY * nearby)])
    tensor = np.diag([0.234375, 0.46875, 0.234375])
    body = Body("top", 15.0, Y, tensor, np.cross(spin, Y), spin)
    joints = [Joint("tip", "spherical", GROUND, 0, HERE, Y)]
    exact = rigid_body(body, -G * Z, -Y, HERE)
    return Mechanism("top", [body], joints, -G * Z, 1.0, [(0, HERE)], exact)


def free_body(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns a free body that spins about its middle axis; a point 1 m off this axis."""
    spin = np.array([0.01, 1.0 + NEARBY * nearby, 0.01])
    body = Body("body", 1.0, HERE, np.diag([1.0, 2.0, 3.0]), HERE, spin)
    offset = unit([1.0, 1.0, 1.0])
    exact = rigid_body(body, HERE, None, offset)
    return Mechanism("free-body", [body], [], HERE, 10.0, [(0, offset)], exact)


def spherical_pendulum(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns a ball of 1 kg and 0.1 m radius on a massless rod of 1 m and a ball joint."""
    speed = 1.0 + NEARBY * nearby
    body = Body("bob", 1.0, X, 4e-3 * np.eye(3), speed * Y, speed * Z)
    joints = [Joint("ball", "spherical", GROUND, 0, HERE)]
    exact = rigid_body(body, -G * Z, -X, HERE)
    return Mechanism("spherical-pendulum", [body], joints, -G * Z, 5.0, [(0, HERE)], exact)


def hexapod(_: int = 1, nearby: int = 0) -> Mechanism:
    """Returns a hexapod without drives: six legs U-P-S; the platform falls straight down."""
    height = 1.2
    speed = NEARBY * nearby
    turns = [120.0 * np.pi / 180.0 * k for k in range(3)]
    feet = [
        1.5 * np.array([np.cos(t + s * 0.25), np.sin(t + s * 0.25), 0.0])
        for t in turns
        for s in (1, -1)
    ]
    heads = [
        0.8 * np.array([np.cos(t + s * 0.8), np.sin(t + s * 0.8), 0.0])
        for t in turns
        for s in (1, -1)
    ]
    low, high = 0.35, 0.35

    def legs(z: float) -> list[tuple[Array, Array, Array, Array]]:
        """Returns centres of cylinder and piston, direction and normal of the plane of each leg."""
        placed = []
        for foot, head in zip(feet, heads, strict=True):
            leg = head + z * Z - foot
            direction = unit(leg)
            normal = unit(np.cross(head - foot, Z))
            placed.append(
                (foot + low * direction, head + z * Z - high * direction, direction, normal)
            )
        return placed

    start = legs(height)

    def pose(z: float) -> tuple[Array, Array]:
        centres, rotations = [z * Z], [np.eye(3)]
        for now, then in zip(legs(z), start, strict=True):
            normal = now[3]
            angle = np.arctan2(normal @ np.cross(then[2], now[2]), then[2] @ now[2])
            centres += [now[0], now[1]]
            rotations += [turned(normal, angle)] * 2
        return np.array(centres), np.array(rotations)

    solid = [Body("platform", 50.0, height * Z, np.diag([4.0, 4.0, 8.0]))]
    joints: list[Joint] = []
    for k, (cylinder, piston, direction, normal) in enumerate(start):
        tensor = rod_tensor(0.7, 3.0, direction)
        solid += [
            Body(f"cylinder-{k}", 3.0, cylinder, tensor),
            Body(f"piston-{k}", 3.0, piston, tensor),
        ]
        own, other = 1 + 2 * k, 2 + 2 * k
        cross = np.cross(direction, normal)
        joints.append(Joint(f"U{k}", "universal", GROUND, own, feet[k], normal, cross))
        joints.append(Joint(f"P{k}", "prismatic", own, other, cylinder, direction))
    rows = (1, 1, 1, 0, 0, 0)
    for k, head in enumerate(heads):
        place = head + height * Z
        joints.append(Joint(f"S{k}", "spherical", 2 + 2 * k, 0, place, None, None, k > 0, rows))
    exact = OneFreedom(solid, -G * Z, pose, (0.2, 1.3), (height, speed))
    step = 1e-5
    before, after = pose(height - step), pose(height + step)
    bodies = []
    for k, body in enumerate(solid):
        velocity = speed * (after[0][k] - before[0][k]) / (2 * step)
        skew = speed * (after[1][k] - before[1][k]) / (2 * step)
        spin = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
        bodies.append(Body(body.name, body.mass, body.centre, body.tensor, velocity, spin))
    watched = [(0, HERE), (1, HERE), (2, HERE)]
    return Mechanism("hexapod", bodies, joints, -G * Z, 0.4, watched, exact.reference(watched))


def thin_four_bars(count: int, nearby: int = 0) -> Mechanism:
    """Returns the n-four-bar in space with rods about 2 cm thick: very unequal tensors."""
    made = n_four_bar(count, nearby, about_itself=1e-3 / 12.0)
    return replace(made, name=f"n-four-bar-thin-{count}")


def planar_four_bars(count: int, nearby: int = 0) -> Mechanism:
    """Returns the n-four-bar in the plane."""
    return n_four_bar(count, nearby, planar=True)


SCENES: dict[str, Callable[..., Mechanism]] = {
    "n-four-bar-plane": planar_four_bars,
    "n-four-bar-space": n_four_bar,
    "n-four-bar-thin": thin_four_bars,
    "three-cranks": three_cranks,
    "slider-crank": slider_crank,
    "bennett": bennett,
    "bricard": bricard,
    "top": top,
    "free-body": free_body,
    "spherical-pendulum": spherical_pendulum,
    "hexapod": hexapod,
}


def make(scene: str, count: int, nearby: int = 0) -> Mechanism:
    """Returns a scene by name; `nearby` displaces its start slightly."""
    return SCENES[scene](count, nearby)


__all__ = ["SCENES", "Reference", "make"]
