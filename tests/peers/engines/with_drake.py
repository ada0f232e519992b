"""Drake: joints of the spanning tree, and loops closed by ball constraints or stiff bushings.

Constraints exist in discrete plants (SAP) and in the CENIC integrator. The other error-controlled
integrators reject or ignore constraints, so for these integrators loops are closed by a bushing, as
in Drake's own example of a four-bar. Options: `scheme` ("sap", or the name of an integrator),
`closure` ("ball" or "bushing"), number of `points` at which a closing hinge is constrained,
`stiffness` (N/m).
"""

from __future__ import annotations

from importlib.metadata import version as version_of

import numpy as np
import pydrake.all as drake

from mechanism import GROUND, Array, Joint, Mechanism, perpendicular
from outcome import Outcome, Run, sampled


def version() -> str:
    """Returns the version of the package."""
    return version_of("drake")


class Plant:
    """The model of a mechanism, and its joints by name."""

    def __init__(self, mechanism: Mechanism, options: dict, step: float) -> None:
        """Builds the plant; `step` is zero for continuous plants."""
        self.mechanism, self.options = mechanism, options
        self.plant = drake.MultibodyPlant(step)
        self.plant.mutable_gravity_field().set_gravity_vector(mechanism.gravity)
        self.bodies = []
        for body in mechanism.bodies:
            t = body.tensor
            tensor = drake.RotationalInertia(t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2])
            inertia = drake.SpatialInertia.MakeFromCentralInertia(body.mass, np.zeros(3), tensor)
            self.bodies.append(self.plant.AddRigidBody(body.name, inertia))
        self.anchor = None
        self.joints = {joint.name: self.add(joint) for joint in mechanism.tree_joints()}
        for joint in mechanism.closing_joints():
            self.close(joint)
        self.plant.Finalize()

    def body(self, index: int) -> drake.RigidBody:
        """Returns a body of the plant; an anchor replaces the world, whose constraints crash."""
        if index != GROUND:
            return self.bodies[index]
        if self.anchor is None:
            unit = drake.RotationalInertia(1.0, 1.0, 1.0)
            inertia = drake.SpatialInertia.MakeFromCentralInertia(1.0, np.zeros(3), unit)
            self.anchor = self.plant.AddRigidBody("anchor", inertia)
            self.plant.WeldFrames(self.plant.world_frame(), self.anchor.body_frame())
        return self.anchor

    def frame(self, joint: Joint, index: int, turn: Array) -> drake.Frame:
        """Returns a frame of a body at the position of a joint."""
        owner = self.plant.world_frame() if index == GROUND else self.bodies[index].body_frame()
        pose = drake.RigidTransform(
            drake.RotationMatrix(turn), joint.at - self.mechanism.centre(index)
        )
        name = f"{joint.name}-{index}"
        return self.plant.AddFrame(drake.FixedOffsetFrame(name, owner, pose))

    def add(self, joint: Joint) -> drake.Joint:
        """Adds a joint of the tree."""
        turn = np.eye(3)
        if joint.kind == "universal":
            turn = np.column_stack([joint.axis, joint.cross, np.cross(joint.axis, joint.cross)])
        elif joint.kind == "spherical" and joint.axis is not None:
            turn = ball_frame(joint)
        frames = [self.frame(joint, index, turn) for index in (joint.first, joint.second)]
        if joint.kind == "spherical":
            made = drake.BallRpyJoint(joint.name, *frames)
        elif joint.kind == "universal":
            made = drake.UniversalJoint(joint.name, *frames)
        elif joint.kind == "prismatic":
            made = drake.PrismaticJoint(joint.name, *frames, joint.axis)
        else:
            made = drake.RevoluteJoint(joint.name, *frames, joint.axis)
        return self.plant.AddJoint(made)

    def close(self, joint: Joint) -> None:
        """Closes a loop."""
        if self.options.get("closure") == "bushing":
            self.close_by_bushing(joint)
            return
        offsets = [np.zeros(3)]
        if joint.kind == "revolute" and self.options.get("points", 1) == 2:
            offsets = [0.25 * joint.axis, -0.25 * joint.axis]
        for offset in offsets:
            places = [
                joint.at + offset - self.mechanism.centre(k) for k in (joint.first, joint.second)
            ]
            self.plant.AddBallConstraint(
                self.body(joint.first), places[0], self.body(joint.second), places[1]
            )

    def close_by_bushing(self, joint: Joint) -> None:
        """Closes a loop by springs along three axes, without torques, with critical damping."""
        stiffness = self.options["stiffness"]
        mass = min(body.mass for body in self.mechanism.bodies)
        damping = 2.0 * np.sqrt(stiffness * 0.1 * mass)
        turn = np.eye(3)
        if joint.axis is not None:
            turn = np.column_stack([*perpendicular(joint.axis), joint.axis])
        frames = [self.frame(joint, index, turn) for index in (joint.first, joint.second)]
        bushing = drake.LinearBushingRollPitchYaw(
            *frames, np.zeros(3), np.zeros(3), np.full(3, stiffness), np.full(3, damping)
        )
        self.plant.AddForceElement(bushing)

    def start(self, context: drake.Context) -> None:
        """Sets the velocities of the start, at which all coordinates are zero."""
        for joint in self.mechanism.tree_joints():
            made, spin = self.joints[joint.name], self.mechanism.relative_spin(joint)
            if joint.kind == "spherical":
                turn = np.eye(3) if joint.axis is None else ball_frame(joint)
                made.set_angular_velocity(context, turn.T @ spin)
            elif joint.kind == "prismatic":
                made.set_translation_rate(context, self.mechanism.sliding_rate(joint))
            elif joint.kind == "universal":
                made.set_angular_rates(context, np.array([spin @ joint.axis, spin @ joint.cross]))
            else:
                made.set_angular_rate(context, spin @ joint.axis)
        for k in self.mechanism.floating_bodies():
            velocity, spin = self.mechanism.twist(k)
            body = self.bodies[k]
            pose = drake.RigidTransform(self.mechanism.centre(k))
            self.plant.SetFreeBodyPose(context, body, pose)
            self.plant.SetFreeBodySpatialVelocity(
                context, body, drake.SpatialVelocity(spin, velocity)
            )


def ball_frame(joint: Joint) -> Array:
    """Returns a frame with x along the axis of a fast spin: only this angle may become large."""
    u, v = perpendicular(joint.axis)
    return np.column_stack([joint.axis, -v, u])


def prepare(mechanism: Mechanism, options: dict, step: float) -> Run:
    """Prepares a run with steps of `step` (SAP), or with this accuracy (error-controlled)."""
    discrete = options["scheme"] == "sap"
    interval = mechanism.interval / max(1, round(mechanism.interval / step))
    made = Plant(mechanism, options, interval if discrete else 0.0)
    builder = drake.DiagramBuilder()
    made.plant.set_name("plant")
    builder.AddSystem(made.plant)
    simulator = drake.Simulator(builder.Build())
    context = made.plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    if not discrete:
        largest = options.get("largest", 0.1)
        drake.ResetIntegratorFromFlags(simulator, options["scheme"], largest)
        integrator = simulator.get_mutable_integrator()
        integrator.set_fixed_step_mode(False)
        integrator.set_target_accuracy(step)
    made.start(context)
    simulator.Initialize()
    times = mechanism.times

    def advance(k: int) -> None:
        simulator.AdvanceTo(float(times[k]))

    def places() -> Array:
        rows = [
            made.plant.EvalBodyPoseInWorld(context, made.bodies[k]) @ offset
            for k, offset in mechanism.watched
        ]
        return np.array(rows)

    def run() -> Outcome:
        return sampled(mechanism.samples, advance, places)

    return run
