"""MuJoCo: hinges of the spanning tree, loops closed by `connect`, which is soft in every setting.

Options: `integrator`; number of `points` (1 or 2) at which a closing hinge is constrained;
`stiffness`, the time constant of the constraints in steps, or "direct" for a stiffness of
0.9/step²; `solver`.
"""

from __future__ import annotations

import mujoco
import numpy as np

from mechanism import GROUND, Array, Joint, Mechanism, unit
from outcome import Outcome, Run, sampled


def version() -> str:
    """Returns the version of the package."""
    return mujoco.__version__


def numbers(values: Array) -> str:
    """Returns a vector as the value of an attribute."""
    return " ".join(repr(float(v)) for v in values)


def joint_text(joint: Joint, mechanism: Mechanism) -> str:
    """Returns the element or elements of a joint of the tree."""
    place = numbers(joint.at - mechanism.centre(joint.second))
    if joint.kind == "spherical":
        return f'<joint name="{joint.name}" type="ball" pos="{place}"/>'
    kind = "slide" if joint.kind == "prismatic" else "hinge"
    axis = numbers(joint.axis)
    text = f'<joint name="{joint.name}" type="{kind}" pos="{place}" axis="{axis}"/>'
    if joint.kind == "universal":
        axis = numbers(joint.cross)
        text += f'<joint name="{joint.name}-2" type="hinge" pos="{place}" axis="{axis}"/>'
    return text


def body_text(mechanism: Mechanism, index: int, parent: int, joint: str) -> str:
    """Returns a body with all bodies that follow it in the tree."""
    body = mechanism.bodies[index]
    t = body.tensor
    inertia = numbers(np.array([t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2]]))
    text = f'<body name="{body.name}" pos="{numbers(body.centre - mechanism.centre(parent))}">'
    text += joint
    text += f'<inertial pos="0 0 0" mass="{body.mass!r}" fullinertia="{inertia}"/>'
    return text + children(mechanism, index) + "</body>"


def children(mechanism: Mechanism, parent: int) -> str:
    """Returns the bodies that follow a body in the tree."""
    return "".join(
        body_text(mechanism, joint.second, parent, joint_text(joint, mechanism))
        for joint in mechanism.tree_joints()
        if joint.first == parent
    )


def connects(mechanism: Mechanism, points: int, stiffness: str) -> str:
    """Returns the equality constraints that close the loops."""
    text = ""
    for joint in mechanism.closing_joints():
        names = [mechanism.bodies[k].name for k in (joint.second, joint.first) if k != GROUND]
        owner = joint.second if joint.second != GROUND else joint.first
        offsets = [np.zeros(3)]
        if joint.kind == "revolute" and points == 2:
            offsets = [0.25 * joint.axis, -0.25 * joint.axis]
        for offset in offsets:
            place = numbers(joint.at + offset - mechanism.centre(owner))
            other = f'body2="{names[1]}"' if len(names) == 2 else ""
            text += f'<connect body1="{names[0]}" {other} anchor="{place}" {stiffness}/>'
    return text


def document(mechanism: Mechanism, options: dict, step: float) -> str:
    """Returns the whole model."""
    factor = options.get("stiffness", 2.0)
    if factor == "direct":
        reference = f"{-0.9 / step**2!r} {-1.8 / step!r}"
    else:
        reference = f"{factor * step!r} 1"
    stiffness = f'solref="{reference}" solimp="0.9999 0.9999 0.001 0.5 2"'
    floating = "".join(
        body_text(mechanism, k, GROUND, "<freejoint/>") for k in mechanism.floating_bodies()
    )
    world = children(mechanism, GROUND) + floating
    return (
        f'<mujoco><compiler angle="radian" balanceinertia="false"/>'
        f'<option timestep="{step!r}" integrator="{options["integrator"]}" '
        f'gravity="{numbers(mechanism.gravity)}" solver="{options.get("solver", "Newton")}" '
        f'jacobian="{options.get("jacobian", "auto")}" tolerance="1e-12" iterations="100">'
        f'<flag contact="disable"/></option><worldbody>{world}</worldbody>'
        f"<equality>{connects(mechanism, options.get('points', 1), stiffness)}</equality></mujoco>"
    )


def start(mechanism: Mechanism, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Sets the velocities of the start, at which all coordinates are zero."""
    for joint in mechanism.tree_joints():
        at = model.joint(joint.name).dofadr[0]
        spin = mechanism.relative_spin(joint)
        if joint.kind == "spherical":
            data.qvel[at : at + 3] = spin
        elif joint.kind == "prismatic":
            data.qvel[at] = mechanism.sliding_rate(joint)
        elif joint.kind == "universal":
            data.qvel[at] = spin @ unit(joint.axis)
            data.qvel[at + 1] = spin @ unit(joint.cross)
        else:
            data.qvel[at] = spin @ joint.axis
    for k in mechanism.floating_bodies():
        at = model.body(mechanism.bodies[k].name).dofadr[0]
        velocity, spin = mechanism.twist(k)
        data.qvel[at : at + 6] = [*velocity, *spin]


def prepare(mechanism: Mechanism, options: dict, step: float) -> Run:
    """Prepares a run with steps of about `step`, a whole number of steps between instants."""
    steps = max(1, round(mechanism.interval / step))
    text = document(mechanism, options, mechanism.interval / steps)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    start(mechanism, model, data)
    mujoco.mj_forward(model, data)
    watched = [(model.body(mechanism.bodies[k].name).id, offset) for k, offset in mechanism.watched]

    def advance(_: int) -> None:
        mujoco.mj_step(model, data, steps)

    def places() -> Array:
        mujoco.mj_kinematics(model, data)
        rows = [data.xpos[k] + data.xmat[k].reshape(3, 3) @ offset for k, offset in watched]
        return np.array(rows)

    def run() -> Outcome:
        outcome = sampled(mechanism.samples, advance, places)
        numbers_of_warnings = sum(int(warning.number) for warning in data.warning)
        note = f"{numbers_of_warnings} warnings" if numbers_of_warnings else outcome.note
        return Outcome(outcome.places, outcome.seconds, note=note)

    return run
