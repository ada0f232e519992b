"""Accelerations and ranks of robot models by MuJoCo, for comparison with imported scenes.

MuJoCo never reads meshes here, because the import does not read them either. What the import omits
and reports is switched off: contacts, limits, friction, actuators, forces of a medium, tendons, and
the nonlinear terms of springs. Constraints of `<equality>` are exact: their softness is replaced by
the exact solution of the equations of motion with the Jacobian of MuJoCo.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

Array = np.ndarray
# Kinds of joints as numbers, because a comparison of an enumeration with a number of numpy is false.
FREE, BALL, HINGE = (
    int(getattr(mujoco.mjtJoint, f"mjJNT_{name}")) for name in ("FREE", "BALL", "HINGE")
)
# Angles and velocities are far from zero, so that every term of the equations matters.
SPREAD = 3.0
# Loops close only near the described pose.
SPREADS_OF_LOOPS = (0.3, 0.3, 0.1, 0.03, 0.0, *[1.0] * 20)
# Constraints are satisfied to the rounding of sums of lengths, which are a few metres at most.
CLOSED = 1e-12
# A change of coordinates by about the rounding of sums along a chain of joints may change
# accelerations by this share.
CHANGE = 1e-14
MOST_SENSITIVE = 1e-9
# Rows whose singular value is smaller than this share of the largest one are dependent. The values
# of independent rows are above 1e-4 in all models that were looked at, the others near 1e-15.
DEPENDENT = 1e-8


# Joints in extensions of URDF.
EXTENSIONS = re.compile(
    r"<loop_joint\b|<\w+:(?:linear_bushing|ball_constraint|joint)|<gazebo[^>]*>\s*<joint\b"
)
# Accelerations are known to fewer than four digits.
SINGULAR = 1e12


class NotComparable(Exception):
    """MuJoCo has no answer for this model. The message is the reason."""


@dataclass
class Loops:
    """Pairs of links whose frames ("6d") or origins ("3d") coincide, and new types of joints."""

    pairs: list[tuple[str, str, str]]
    joints: list[tuple[str, str]]


@dataclass
class State:
    q: Array
    v: Array


@dataclass
class Motion:
    """Mass centre of a body, its acceleration, and the angular acceleration, along ground axes."""

    centre: Array
    linear: Array
    angular: Array

    def numbers(self) -> Array:
        return np.concatenate([self.linear, self.angular])


def size_of(motions: dict[str, Motion]) -> float:
    """Returns the largest component of an acceleration, which counts as at least 1."""
    return max(1.0, *(float(np.abs(motion.numbers()).max()) for motion in motions.values()))


def load(path: Path, loops: Loops | None = None, has_masses: bool = True) -> mujoco.MjModel:
    """Reads MJCF or URDF without meshes and without the content that the import omits.

    Without masses, every body gets the same mass. The ranks do not depend on masses.
    """
    text = path.read_text(errors="replace")
    is_urdf = re.search(r"<\s*robot[\s>]", text) is not None
    try:
        # MuJoCo finds included files only beside a file, and recognises URDF only in a text.
        spec = mujoco.MjSpec.from_string(text) if is_urdf else mujoco.MjSpec.from_file(str(path))
    except (ValueError, mujoco.FatalError) as error:
        raise NotComparable(f"MuJoCo cannot read it: {first_line(error)}") from error
    strip(spec, is_urdf)
    if is_urdf and EXTENSIONS.search(text):
        raise NotComparable("MuJoCo does not read joints of extensions of URDF")
    if loops:
        close(spec, text, loops)
    # MJCF bounds and scales masses, and these come from geoms.
    return compiled(spec, has_masses, is_massless_allowed=is_urdf)


def compiled(spec: mujoco.MjSpec, has_masses: bool, is_massless_allowed: bool) -> mujoco.MjModel:
    """Compiles a specification. MuJoCo rejects bodies without mass, so these get it for a time."""
    massless: dict[str, bool] = {}
    for body in spec.bodies[1:]:
        if not has_masses or (is_massless_allowed and not (body.explicitinertial and body.mass)):
            moments = np.nan_to_num([*body.fullinertia, *body.inertia])
            turns = has_masses and body.explicitinertial and bool(moments.any())
            massless[body.name] = turns
            body.explicitinertial, body.mass = True, 1.0
            if not turns:
                body.fullinertia, body.inertia = [np.nan] * 6, [1.0, 1.0, 1.0]
                body.ipos, body.iquat = [0.0] * 3, [1.0, 0.0, 0.0, 0.0]
    try:
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise NotComparable(f"MuJoCo cannot compile it: {first_line(error)}") from error
    for name, turns in massless.items() if has_masses else ():
        body = model.body(name).id
        model.body_mass[body] = 0.0
        model.body_inertia[body] *= turns
    switch_off(model)
    return model


def first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


def strip(spec: mujoco.MjSpec, is_urdf: bool) -> None:
    """Removes meshes and content without an effect. URDF has masses only in `<inertial>`."""
    kinds = mujoco.mjtGeom
    meshes = (kinds.mjGEOM_MESH, kinds.mjGEOM_HFIELD, kinds.mjGEOM_SDF)
    without = []
    for geom in list(spec.geoms):
        if is_urdf or geom.type in meshes or geom.meshname:
            without.append(geom.parent)
            spec.delete(geom)
    for body in without:
        if not body.geoms and not body.explicitinertial:
            # MuJoCo would take the position of the body as its mass centre, for bounds of masses.
            body.ipos, body.iquat = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]
    lists = (
        spec.keys, spec.sensors, spec.actuators, spec.pairs, spec.excludes, spec.skins,
        spec.tuples, spec.meshes, spec.hfields, spec.materials, spec.textures,
    )  # fmt: skip
    for elements in lists:
        for element in list(elements):
            spec.delete(element)
    for element in (*spec.geoms, *spec.sites, *spec.tendons):
        element.material = ""
    for body in spec.bodies:
        body.plugin.active = False
    for joint in spec.joints:
        joint.springdamper = [0.0, 0.0]
        if int(joint.type) in (BALL, FREE):
            joint.armature, joint.damping = 0.0, [0.0] * len(joint.damping)
        if int(joint.type) == FREE:
            joint.stiffness = [0.0] * len(joint.stiffness)
    spec.compiler.fusestatic = False


def close(spec: mujoco.MjSpec, urdf: str, loops: Loops) -> None:
    """Changes the types of joints, and adds the closures of loops."""
    hinge, ball = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_BALL
    robot = ElementTree.fromstring(urdf)
    links = {link.get("name") for link in robot.findall("link")}
    places = {
        joint.get("name"): joint.find("child").get("link") for joint in robot.findall("joint")
    }

    def body_of(name: str) -> mujoco.MjsBody:
        """Returns the body of a link, or of the link that a joint places."""
        link = name if name in links else places.get(name, "")
        # MuJoCo attaches the content of the root link to the world.
        is_root = link in links and link not in places.values()
        body = spec.worldbody if is_root else spec.body(link)
        if body is None:
            raise NotComparable(f"MuJoCo has no body `{name}` of a loop")
        return body

    for name, kind in loops.joints:
        body = body_of(places.get(name, ""))
        for joint in list(body.joints):
            spec.delete(joint)
        if kind == "SPHERICAL":
            body.add_joint(name=name, type=ball)
            continue
        for letter in kind.removeprefix("UJOINT_"):
            axis = [float(letter == other) for other in "XYZ"]
            body.add_joint(name=f"{name} {letter}", type=hinge, axis=axis)
    of_pair = {"6d": mujoco.mjtEq.mjEQ_WELD, "3d": mujoco.mjtEq.mjEQ_CONNECT}
    for number, (first, second, kind) in enumerate(loops.pairs):
        for end, link in enumerate((first, second)):
            body_of(link).add_site(name=f"loop {number} {end}")
        names = {"name1": f"loop {number} 0", "name2": f"loop {number} 1"}
        spec.add_equality(type=of_pair[kind], objtype=mujoco.mjtObj.mjOBJ_SITE, **names)


def switch_off(model: mujoco.MjModel) -> None:
    for bit in ("CONTACT", "LIMIT", "FRICTIONLOSS", "ACTUATION", "ISLAND"):
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{bit}")
    model.opt.enableflags = 0
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    # MuJoCo would drop rotations below about 1e-6 between the frames of a body.
    model.body_sameframe[:], model.site_sameframe[:] = 0, 0
    model.opt.density, model.opt.viscosity, model.opt.wind[:] = 0.0, 0.0, 0.0
    model.dof_dampingpoly[:], model.jnt_stiffnesspoly[:] = 0.0, 0.0
    for name in ("stiffness", "damping", "armature", "stiffnesspoly", "dampingpoly"):
        getattr(model, f"tendon_{name}")[:] = 0.0
    model.jnt_actgravcomp[:] = 0


def states(model: mujoco.MjModel, count: int, rng: np.random.Generator) -> list[State]:
    """Returns random states that satisfy the constraints and whose accelerations are not sensitive.

    Near singular configurations and for bodies of nearly no inertia, rounding decides.
    """
    out: list[State] = []
    for _ in range(5 * count):
        q, v = random_state(model, rng, SPREAD)
        if has_constraints(model):
            q, v = constrained_state(model, rng)
        state = State(q, v)
        if sensitivity(model, state, rng) < MOST_SENSITIVE:
            out.append(state)
        if len(out) == count:
            return out
    raise NotComparable("rounding decides about the accelerations")


def sensitivity(model: mujoco.MjModel, state: State, rng: np.random.Generator) -> float:
    """Returns the relative change of accelerations if coordinates change in the last digits."""
    q = state.q.copy()
    mujoco.mj_integratePos(model, q, rng.uniform(-1, 1, model.nv), CHANGE)
    before = accelerations(model, state)
    if not before:
        return 0.0
    after = accelerations(model, State(q, state.v))
    change = max(np.abs(after[name].numbers() - before[name].numbers()).max() for name in before)
    return float(change / size_of(before))


def has_constraints(model: mujoco.MjModel) -> bool:
    return bool(np.any(model.eq_active0))


def constrained_state(model: mujoco.MjModel, rng: np.random.Generator) -> tuple[Array, Array]:
    q = closed(model, rng)
    constraints = jacobian(model, q)
    v = rng.uniform(-SPREAD, SPREAD, model.nv)
    return q, v - np.linalg.pinv(constraints, rcond=DEPENDENT) @ (constraints @ v)


def closed(model: mujoco.MjModel, rng: np.random.Generator) -> Array:
    """Returns coordinates that satisfy the constraints, near the described pose if possible."""
    for spread in SPREADS_OF_LOOPS:
        q = closest(model, random_state(model, rng, spread)[0])
        if q is not None:
            return q
    raise NotComparable("no state was found that satisfies the equality constraints")


def random_state(
    model: mujoco.MjModel, rng: np.random.Generator, spread: float
) -> tuple[Array, Array]:
    """Returns coordinates about the reference and velocities. Lengths differ by a third."""
    q = model.qpos0.copy()
    for joint in range(model.njnt):
        at, kind = model.jnt_qposadr[joint], model.jnt_type[joint]
        if kind == FREE:
            q[at : at + 3] += rng.uniform(-spread, spread, 3) / 3
            at += 3
        if kind in (FREE, BALL):
            # Springs of ball joints have no value in scenes beyond 3 rad.
            turn = rng.uniform(-spread, spread, 3)
            turn *= min(1.0, 2.9 / max(float(np.linalg.norm(turn)), 1e-9))
            mujoco.mju_quatIntegrate(q[at : at + 4], turn, 1.0)
        elif kind == HINGE:
            q[at] += rng.uniform(-spread, spread)
        else:
            q[at] += rng.uniform(-spread, spread) / 3
    return q, rng.uniform(-SPREAD, SPREAD, model.nv)


def evaluated(model: mujoco.MjModel, q: Array, v: Array | None = None) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qpos[:] = q
    data.qvel[:] = 0.0 if v is None else v
    mujoco.mj_forward(model, data)
    return data


def jacobian(model: mujoco.MjModel, q: Array) -> Array:
    return rows_of(model, evaluated(model, q))


def rows_of(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Returns the rows of the active constraints. MuJoCo may keep more numbers."""
    return data.efc_J.ravel()[: data.nefc * model.nv].reshape(data.nefc, model.nv).copy()


def closest(model: mujoco.MjModel, q: Array) -> Array | None:
    """Returns coordinates near `q` that satisfy the constraints, by Newton's method."""
    q = q.copy()
    left = None
    for _ in range(50):
        data = evaluated(model, q)
        gap = np.abs(data.efc_pos).max(initial=0.0)
        # Further steps reduce the gap to the rounding.
        if gap < CLOSED and left is None:
            left = 3
        if gap == 0.0 or left == 0:
            return q
        left = None if left is None else left - 1
        constraints = rows_of(model, data)
        step = -np.linalg.pinv(constraints, rcond=DEPENDENT) @ data.efc_pos
        mujoco.mj_integratePos(model, q, step * min(1.0, 0.5 / max(np.abs(step).max(), 1e-9)), 1.0)
    return None


def rank(model: mujoco.MjModel) -> tuple[int, int]:
    """Returns the number of constraint rows and their rank at the described pose."""
    if not has_constraints(model):
        return 0, 0
    q = closest(model, model.qpos0)
    if q is None:
        q = closed(model, np.random.default_rng(0))
    constraints = jacobian(model, q)
    values = np.linalg.svd(constraints, compute_uv=False)
    return len(constraints), int(np.sum(values > DEPENDENT * max(values.max(initial=0.0), 1e-300)))


def accelerations(model: mujoco.MjModel, state: State) -> dict[str, Motion]:
    """Returns the motions of bodies that move, by name. Bodies without joints belong to others."""
    data = evaluated(model, state.q, state.v)
    solution = joint_accelerations(model, data, state)
    out = {}
    for body, members in groups(model).items():
        mass = model.body_mass[members]
        centre = mass @ data.xipos[members] / mass.sum()
        linear, angular, linear_rate, angular_rate = (np.zeros((3, model.nv)) for _ in range(4))
        mujoco.mj_jac(model, data, linear, angular, centre, body)
        mujoco.mj_jacDot(model, data, linear_rate, angular_rate, centre, body)
        out[model.body(body).name or f"unnamed {body}"] = Motion(
            centre,
            linear @ solution + linear_rate @ state.v,
            angular @ solution + angular_rate @ state.v,
        )
    return out


def groups(model: mujoco.MjModel) -> dict[int, list[int]]:
    """Returns the bodies that move together, by their first body."""
    out: dict[int, list[int]] = {}
    for body in range(1, model.nbody):
        first = int(model.body_weldid[body])
        if model.body_dofnum[first] > 0:
            out.setdefault(first, []).append(body)
    return {k: members for k, members in out.items() if model.body_mass[members].sum() > 0}


def joint_accelerations(model: mujoco.MjModel, data: mujoco.MjData, state: State) -> Array:
    """Solves the equations of motion with exact constraints, by a basis of the free motions."""
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    needed, free = np.zeros(model.nv), np.eye(model.nv)
    if data.nefc:
        constraints = rows_of(model, data)
        inverse = np.linalg.pinv(constraints, rcond=DEPENDENT)
        needed = -inverse @ rate_of_jacobian(model, data, state)
        _, values, basis = np.linalg.svd(constraints)
        free = basis[int(np.sum(values > DEPENDENT * values.max())) :].T
    if not free.shape[1]:
        return needed
    reduced = free.T @ mass @ free
    scale = 1 / np.sqrt(np.maximum(reduced.diagonal(), 1e-300))
    if reduced.diagonal().min() <= 0 or np.linalg.cond(scale[:, None] * reduced * scale) > SINGULAR:
        raise NotComparable("a body without mass moves, so accelerations do not exist")
    force = free.T @ (data.qfrc_smooth - mass @ needed)
    return needed + free @ (
        scale * np.linalg.solve(scale[:, None] * reduced * scale, scale * force)
    )


def rate_of_jacobian(model: mujoco.MjModel, data: mujoco.MjData, state: State) -> Array:
    """Returns dJ/dt·v by central differences of eighth order along the motion."""
    # The fastest rotation advances by 0.02 rad in a step. The error of the differences and the
    # rounding are then both below 1e-12.
    fastest = max(np.abs(data.cvel[:, :3]).max(), 1.0)
    step = 0.02 / fastest
    out = np.zeros(data.nefc)
    for k, weight in ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280)):
        for sign in (1, -1):
            q = state.q.copy()
            mujoco.mj_integratePos(model, q, state.v, sign * k * step)
            rows = jacobian(model, q)
            if len(rows) != data.nefc:
                raise NotComparable("MuJoCo drops constraint rows at some states")
            out += sign * weight / step * (rows @ state.v)
    return out


def largest_difference(theirs: dict[str, Motion], ours: dict[str, Motion]) -> float:
    """Returns the largest difference as a share of the largest acceleration, at least of 1.

    Every body of MuJoCo must be in the scene. Bodies without a name are found by their mass centre.
    """
    size = size_of(theirs)
    worst = 0.0
    for name, motion in theirs.items():
        other = ours.get(name) or most_similar(motion, ours)
        if np.abs(motion.centre - other.centre).max() > 1e-9 * max(
            1.0, np.abs(motion.centre).max()
        ):
            raise Differs(f"the mass centre of `{name}` is elsewhere")
        worst = max(worst, float(np.abs(motion.numbers() - other.numbers()).max()) / size)
    return worst


class Differs(Exception):
    """Bodies of both sides do not correspond."""


def most_similar(motion: Motion, ours: dict[str, Motion]) -> Motion:
    """Returns the most similar motion of the bodies whose mass centre is nearest."""

    def distance(other: Motion) -> tuple[float, float]:
        apart = float(np.abs(other.centre - motion.centre).max())
        return round(apart, 9), float(np.abs(motion.numbers() - other.numbers()).max())

    if not ours:
        raise Differs("the scene has no bodies")
    return min(ours.values(), key=distance)


def parsed(text: str) -> dict[int, dict[str, Motion]]:
    """Returns the lines of `imported_accelerations`, by state and body."""
    out: dict[int, dict[str, Motion]] = {}
    for line in text.splitlines():
        state, body, *numbers = line.split("\t")
        values = np.array([float(x) for x in numbers])
        out.setdefault(int(state), {})[body] = Motion(values[:3], values[3:6], values[6:9])
    return out


def with_keyframes(text: str, chosen: list[State]) -> str:
    """Returns the text of a MJCF file with these states as further keyframes."""
    keys = []
    for number, state in enumerate(chosen):
        q, v = (" ".join(repr(float(x)) for x in of) for of in (state.q, state.v))
        keys.append(f'<key name="state {number}" qpos="{q}" qvel="{v}"/>')
    end = text.rfind("</mujoco")
    if end < 0:
        raise NotComparable("the file has no element <mujoco>")
    return f"{text[:end]}<keyframe>{''.join(keys)}</keyframe>{text[end:]}"


def with_start(scene: str, model: mujoco.MjModel, state: State) -> str:
    """Returns the text of a scene whose bodies start at this state of the model."""
    data = evaluated(model, state.q, state.v)
    out = []
    name = None
    for line in [*scene.splitlines(), ""]:
        if line == "[[body]]":
            name = ""
        elif name == "" and line.startswith("name = "):
            name = line.removeprefix("name = ").strip('"')
        elif not line and name:
            out += start_of(name, model, data, state)
            name = None
        out.append(line)
    return "\n".join(out)


def start_of(name: str, model: mujoco.MjModel, data: mujoco.MjData, state: State) -> list[str]:
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    if body < 0:
        return []
    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, linear, angular, data.xpos[body], body)
    pose = f"position = {listed(data.xpos[body])}"
    turned = f"orientation = {{ quaternion = {listed(data.xquat[body])} }}"
    return [
        f"start = {{ {pose}, {turned} }}",
        f"velocity = {listed(linear @ state.v)}",
        f"angular_velocity = {listed(angular @ state.v)}",
    ]


def listed(numbers: Array) -> str:
    return f"[{', '.join(repr(float(x)) for x in numbers)}]"
