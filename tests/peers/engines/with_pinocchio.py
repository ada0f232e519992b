"""Pinocchio: accelerations by `constraintDynamics` (proximal), with our own integration loop.

The library has no integrator. Its accelerations are C++, and our loop is Python, which takes most
of the time for small mechanisms; `other_clock` is the time of the accelerations alone. Options:
`method` ("rk4" or "rk8", the twelve stages of Dormand and Prince), number of `points` at which a
closing hinge is constrained, `mu` of the proximal iteration, `gain` of the Baumgarte correction
(1/s).
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pinocchio as pin
from scipy.integrate import DOP853

from mechanism import GROUND, Array, Joint, Mechanism
from outcome import Outcome, Run, sampled


def version() -> str:
    """Returns the version of the package."""
    return pin.__version__


def joint_model(joint: Joint, axis: Array | None) -> pin.JointModel:
    """Returns a joint of the tree."""
    if joint.kind == "spherical":
        return pin.JointModelSpherical()
    if joint.kind == "prismatic":
        return pin.JointModelPrismaticUnaligned(*axis)
    for unit, model in zip(
        np.eye(3), (pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ), strict=True
    ):
        if np.array_equal(unit, axis):
            return model()
    return pin.JointModelRevoluteUnaligned(*axis)


class Tree:
    """The model of a mechanism, with its constraints."""

    def __init__(self, mechanism: Mechanism, options: dict) -> None:
        """Builds the model."""
        self.mechanism, self.options = mechanism, options
        self.model = pin.Model()
        self.model.gravity.linear = mechanism.gravity
        self.joints: dict[int, int] = {GROUND: 0}
        self.origins: dict[int, Array] = {GROUND: np.zeros(3)}
        self.balls: list[tuple[int, int]] = []
        for k in mechanism.floating_bodies():
            centre = mechanism.centre(k)
            free = pin.JointModelFreeFlyer()
            joint = self.model.addJoint(0, free, pin.SE3(np.eye(3), centre), f"free-{k}")
            self.attach(k, joint, centre)
            self.grow(k)
        self.grow(GROUND)
        self.data = self.model.createData()
        self.constraints = pin.StdVec_RigidConstraintModel()
        for joint in mechanism.closing_joints():
            self.close(joint)
        self.constraint_data = pin.StdVec_RigidConstraintData()
        for constraint in self.constraints:
            self.constraint_data.append(constraint.createData())
        pin.initConstraintDynamics(self.model, self.data, self.constraints, self.constraint_data)

    def attach(self, body: int, joint: int, origin: Array) -> None:
        """Attaches a body to a joint of the model."""
        given = self.mechanism.bodies[body]
        inertia = pin.Inertia(given.mass, given.centre - origin, given.tensor)
        self.model.appendBodyToJoint(joint, inertia, pin.SE3.Identity())
        self.joints[body], self.origins[body] = joint, origin

    def grow(self, parent: int) -> None:
        """Adds all bodies after a body, depth first: in another order the forces are wrong."""
        for joint in self.mechanism.tree_joints():
            if joint.first == parent:
                self.add(joint)
                self.grow(joint.second)

    def add(self, joint: Joint) -> None:
        """Adds a joint of the tree; a universal joint is two hinges without a body between them."""
        place = pin.SE3(np.eye(3), joint.at - self.origins[joint.first])
        parent = self.joints[joint.first]
        made = self.model.addJoint(parent, joint_model(joint, joint.axis), place, joint.name)
        if joint.kind == "universal":
            made = self.model.addJoint(
                made, joint_model(joint, joint.cross), pin.SE3.Identity(), f"{joint.name}-2"
            )
        self.attach(joint.second, made, joint.at)

    def close(self, joint: Joint) -> None:
        """Adds point constraints that close a loop."""
        offsets = [np.zeros(3)]
        if joint.kind == "revolute" and self.options.get("points", 1) == 2:
            offsets = [0.25 * joint.axis, -0.25 * joint.axis]
        for offset in offsets:
            frames = [
                pin.SE3(np.eye(3), joint.at + offset - self.origins[k])
                for k in (joint.second, joint.first)
            ]
            constraint = pin.RigidConstraintModel(
                pin.ContactType.CONTACT_3D,
                self.model,
                self.joints[joint.second],
                frames[0],
                self.joints[joint.first],
                frames[1],
                pin.ReferenceFrame.LOCAL,
            )
            gain = self.options.get("gain", 0.0)
            parameters = getattr(constraint, "corrector", None)
            if parameters is None:
                parameters = constraint.m_baumgarte_parameters
            parameters.Kp, parameters.Kd = gain**2, 2.0 * gain
            self.constraints.append(constraint)

    def start(self) -> tuple[Array, Array]:
        """Returns coordinates and velocities of the start."""
        q, v = pin.neutral(self.model), np.zeros(self.model.nv)
        for joint in self.mechanism.tree_joints():
            at = self.model.joints[self.joints[joint.second]].idx_v
            spin = self.mechanism.relative_spin(joint)
            if joint.kind == "spherical":
                v[at : at + 3] = spin
            elif joint.kind == "prismatic":
                v[at] = self.mechanism.sliding_rate(joint)
            elif joint.kind == "universal":
                v[at - 1], v[at] = spin @ joint.axis, spin @ joint.cross
            else:
                v[at] = spin @ joint.axis
        for k in self.mechanism.floating_bodies():
            at = self.model.joints[self.joints[k]].idx_v
            v[at : at + 6] = np.r_[self.mechanism.twist(k)]
        return q, v


class Charts:
    """Coordinates as a vector, with the rates and the normalisation of quaternions."""

    def __init__(self, model: pin.Model) -> None:
        """Finds the joints whose coordinates are not angles."""
        self.is_flat = model.nq == model.nv
        self.flat: list[tuple[int, int]] = []
        self.balls: list[tuple[int, int]] = []
        self.free: list[tuple[int, int]] = []
        for joint in list(model.joints)[1:]:
            kinds = {3: self.balls, 6: self.free}
            kinds.get(joint.nv, self.flat).append((joint.idx_q, joint.idx_v))
        self.flat_q = [q for q, _ in self.flat]
        self.flat_v = [v for _, v in self.flat]

    def rates(self, q: Array, v: Array) -> Array:
        """Returns the derivative of the coordinates."""
        if self.is_flat:
            return v
        made = np.empty(len(q))
        made[self.flat_q] = v[self.flat_v]
        for at, of in self.balls:
            made[at : at + 4] = spun(q[at : at + 4], v[of : of + 3])
        for at, of in self.free:
            turn = pin.Quaternion(q[at + 3 : at + 7]).toRotationMatrix()
            made[at : at + 3] = turn @ v[of : of + 3]
            made[at + 3 : at + 7] = spun(q[at + 3 : at + 7], v[of + 3 : of + 6])
        return made

    def on(self, q: Array) -> Array:
        """Normalises the quaternions."""
        for at in [*(at for at, _ in self.balls), *(at + 3 for at, _ in self.free)]:
            q[at : at + 4] /= math.sqrt(q[at : at + 4] @ q[at : at + 4])
        return q


def spun(q: Array, spin: Array) -> list[float]:
    """Returns the derivative of a quaternion (x, y, z, w) for an angular velocity of the body."""
    x, y, z, w = q.tolist()
    a, b, c = (0.5 * spin).tolist()
    return [
        w * a + y * c - z * b,
        w * b + z * a - x * c,
        w * c + x * b - y * a,
        -x * a - y * b - z * c,
    ]


def tableau(method: str) -> tuple[list[Array], Array]:
    """Returns the rows of the stages and the weights of an explicit method."""
    if method == "rk4":
        rows = [np.array([]), np.array([0.5]), np.array([0.0, 0.5]), np.array([0.0, 0.0, 1.0])]
        return rows, np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
    return [row[:k] for k, row in enumerate(DOP853.A)], DOP853.B


def prepare(mechanism: Mechanism, options: dict, step: float) -> Run:
    """Prepares a run with steps of `step`, shortened before each instant to end there."""
    tree = Tree(mechanism, options)
    model, data = tree.model, tree.data
    whole = max(0, math.ceil(mechanism.interval / step - 1e-9) - 1)
    steps = [step] * whole + [mechanism.interval - whole * step]
    settings = pin.ProximalSettings(1e-12, options.get("mu", 1e-8), options.get("iterations", 20))
    force = np.zeros(model.nv)
    stages, weights = tableau(options["method"])
    charts = Charts(model)
    inside = [0.0]
    state = list(tree.start())

    def acceleration(q: Array, v: Array) -> Array:
        begin = time.perf_counter()
        made = pin.constraintDynamics(
            model, data, q, v, force, tree.constraints, tree.constraint_data, settings
        )
        inside[0] += time.perf_counter() - begin
        return made

    def one_step(q: Array, v: Array, h: float) -> tuple[Array, Array]:
        rates = np.empty((len(stages), model.nq))
        accelerations = np.empty((len(stages), model.nv))
        for k, row in enumerate(stages):
            speed = v + h * (row @ accelerations[:k]) if k else v
            place = charts.on(q + h * (row @ rates[:k])) if k else q
            rates[k] = charts.rates(place, speed)
            accelerations[k] = acceleration(place, speed)
        return charts.on(q + h * (weights @ rates)), v + h * (weights @ accelerations)

    def advance(_: int) -> None:
        for h in steps:
            state[:] = one_step(*state, h)

    def places() -> Array:
        pin.forwardKinematics(model, data, state[0])
        rows = []
        for k, offset in mechanism.watched:
            arm = mechanism.centre(k) - tree.origins[k] + offset
            rows.append(data.oMi[tree.joints[k]].act(arm))
        return np.array(rows)

    def run() -> Outcome:
        outcome = sampled(mechanism.samples, advance, places)
        return replace(outcome, other_clock=inside[0])

    return run
