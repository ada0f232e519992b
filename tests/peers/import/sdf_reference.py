"""Builds a MuJoCo model from a SDF file with one model, because MuJoCo does not read SDF.

It follows the specification <http://sdformat.org/spec> and shares nothing with the import.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from reference import NotComparable, compiled

Array = np.ndarray
Element = ElementTree.Element
# The import states that it takes this gravity if the file has none.
GRAVITY = [0.0, 0.0, -9.81]
KINDS = {
    "revolute": [mujoco.mjtJoint.mjJNT_HINGE],
    "continuous": [mujoco.mjtJoint.mjJNT_HINGE],
    "prismatic": [mujoco.mjtJoint.mjJNT_SLIDE],
    "ball": [mujoco.mjtJoint.mjJNT_BALL],
    "fixed": [],
    "universal": [mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_HINGE],
    "revolute2": [mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_HINGE],
}


def load_sdf(path: Path, has_masses: bool = True) -> mujoco.MjModel:
    """Reads a file. Without masses, every body gets the same mass."""
    try:
        root = ElementTree.fromstring(without_prefixes(path.read_text()))
    except ElementTree.ParseError as error:
        raise NotComparable("the file is not well-formed") from error
    around = root if root.find("world") is None else root.find("world")
    models = around.findall("model")
    if len(models) != 1 or models[0].findall("model") or models[0].findall("include"):
        raise NotComparable("several models or included models in SDF")
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    gravity = around.findtext("gravity")
    spec.option.gravity = numbers(gravity) if gravity else GRAVITY
    Builder(models[0], version_of(root), spec).build()
    return compiled(spec, has_masses, is_massless_allowed=True)


def without_prefixes(text: str) -> str:
    """Removes prefixes of names, which files of SDF use without a declaration."""
    text = re.sub(r"^\s*<\?xml[^>]*\?>", "", text)
    return re.sub(r"(</?|\s)\w+:(?=[\w.-]+[\s=/>])", r"\1", text)


def version_of(root: Element) -> tuple[int, ...]:
    return tuple(int(part) for part in root.get("version", "1.6").split("."))


def numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]


def pose_of(element: Element | None) -> Array:
    """Returns the matrix of a pose of six numbers, or of seven numbers with a quaternion."""
    out = np.eye(4)
    if element is None or not (element.text or "").strip():
        return out
    values = numbers(element.text or "")
    out[:3, 3] = values[:3]
    if element.get("rotation_format") == "quat_xyzw":
        x, y, z, w = values[3:]
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, np.array([w, x, y, z]) / np.linalg.norm(values[3:]))
        out[:3, :3] = rotation.reshape(3, 3)
    else:
        unit = np.pi / 180 if element.get("degrees") in ("true", "1") else 1.0
        out[:3, :3] = roll_pitch_yaw(*(unit * angle for angle in values[3:]))
    return out


def roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Array:
    (a, b, c), (d, e, f) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, a, -d], [0, d, a]])
    about_y = np.array([[b, 0, e], [0, 1, 0], [-e, 0, b]])
    about_z = np.array([[c, -f, 0], [f, c, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def quaternion(rotation: Array) -> Array:
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(rotation).flatten())
    return out


class Builder:
    """Adds the links of a model to a specification of MuJoCo."""

    def __init__(self, model: Element, version: tuple[int, ...], spec: mujoco.MjSpec) -> None:
        self.model, self.version, self.spec = model, version, spec
        self.links = {link.get("name", ""): link for link in model.findall("link")}
        self.joints = model.findall("joint")
        self.frames = {frame.get("name", ""): frame for frame in model.findall("frame")}
        self.by_joint = {joint.get("name", ""): joint for joint in self.joints}
        self.base = pose_of(model.find("pose"))
        self.bodies: dict[str, mujoco.MjsBody] = {}

    def build(self) -> None:
        if (self.model.findtext("static") or "").strip() in ("true", "1"):
            raise NotComparable("the model is static")
        if "world" in self.links:
            raise NotComparable("a link is called `world`, which SDF reserves")
        before: dict[str, Element] = {}
        for joint in self.joints:
            child = self.link_of((joint.findtext("child") or "").strip())
            if joint.get("type") not in KINDS or child in before or child == "world":
                raise NotComparable(f"joint `{joint.get('name')}` of type {joint.get('type')}")
            if joint.find("axis/mimic") is not None:
                raise NotComparable("coupled joints in SDF")
            before[child] = joint
        for name in self.links:
            self.add(name, before, [])

    def add(self, name: str, before: dict[str, Element], above: list[str]) -> mujoco.MjsBody:
        """Adds a link after the links that carry it."""
        if name == "world":
            return self.spec.worldbody
        if name in self.bodies:
            return self.bodies[name]
        if name in above or name not in self.links:
            raise NotComparable(f"link `{name}` of a joint is missing or in a cycle")
        joint = before.get(name)
        parent, parent_pose = self.spec.worldbody, np.eye(4)
        if joint is not None:
            carrier = self.link_of((joint.findtext("parent") or "").strip())
            parent = self.add(carrier, before, [*above, name])
            parent_pose = np.eye(4) if carrier == "world" else self.pose(carrier)
        own = self.pose(name)
        relative = np.linalg.inv(parent_pose) @ own
        body = parent.add_body(name=name, pos=relative[:3, 3], quat=quaternion(relative[:3, :3]))
        self.bodies[name] = body
        self.add_mass(body, self.links[name])
        if joint is None:
            body.add_freejoint()
        else:
            self.add_joint(body, joint, own)
        return body

    def add_mass(self, body: mujoco.MjsBody, link: Element) -> None:
        inertial = link.find("inertial")
        pose = pose_of(None if inertial is None else inertial.find("pose"))
        get = (lambda _: None) if inertial is None else inertial.findtext
        keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        found = [get(f"inertia/{key}") for key in keys]
        defaults = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
        moments = [d if t is None else float(t) for t, d in zip(found, defaults, strict=True)]
        body.explicitinertial = True
        body.mass = float(get("mass") or 1.0)
        xx, yy, zz, xy, xz, yz = moments
        own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        turned = pose[:3, :3] @ own @ pose[:3, :3].T
        body.ipos = pose[:3, 3]
        body.fullinertia = turned[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        falls = (link.findtext("gravity") or "true").strip()
        body.gravcomp = 0.0 if falls in ("true", "1") else 1.0

    def add_joint(self, body: mujoco.MjsBody, joint: Element, link: Array) -> None:
        """Adds the joints of a link. The axes of universal joints belong to different links."""
        name = joint.get("name", "")
        frame = np.linalg.inv(link) @ self.pose_of_joint(joint)
        for number, kind in enumerate(KINDS[joint.get("type", "")]):
            axis = joint.find("axis2" if number else "axis")
            direction = frame[:3, :3] @ np.array([0.0, 0.0, 1.0])
            load = (0.0, 0.0, 0.0)
            if axis is not None:
                direction = np.linalg.inv(link[:3, :3]) @ self.direction(axis, joint)
                load = load_of(axis)
            if kind == mujoco.mjtJoint.mjJNT_BALL:
                load = (0.0, 0.0, 0.0)
            body.add_joint(
                name=f"{name} {number}", type=kind, pos=frame[:3, 3], axis=direction,
                damping=[load[0], 0, 0], stiffness=[load[1], 0, 0], springref=load[2],
            )  # fmt: skip

    def direction(self, axis: Element, joint: Element) -> Array:
        """Returns an axis of a joint in ground axes."""
        xyz = axis.find("xyz")
        values = np.array(numbers(xyz.text if xyz is not None else "0 0 1"))
        if self.version < (1, 5):
            return self.base[:3, :3] @ values
        if (axis.findtext("use_parent_model_frame") or "").strip() in ("true", "1"):
            return self.base[:3, :3] @ values
        around = xyz.get("expressed_in") if xyz is not None else None
        frame = self.pose(around) if around else self.pose_of_joint(joint)
        return frame[:3, :3] @ values

    def link_of(self, name: str) -> str:
        """Returns the link of a name, which may be a frame that is attached to a link."""
        for _ in range(len(self.frames) + 1):
            if name in self.links or name == "world":
                return name
            frame = self.frames.get(name)
            if frame is None or not frame.get("attached_to"):
                break
            name = frame.get("attached_to", "")
        raise NotComparable(f"`{name}` is not a link")

    def pose(self, name: str, depth: int = 0) -> Array:
        """Returns the pose of a link, frame or joint in ground axes."""
        if name == "__model__":
            return self.base
        if name in ("world", "ground"):
            return np.eye(4)
        if depth > 100:
            raise NotComparable("poses refer to each other")
        for table in (self.links, self.frames):
            if name in table:
                element = table[name]
                default = element.get("attached_to") or "__model__"
                return self.relative(element, default, depth)
        if name in self.by_joint:
            return self.pose_of_joint(self.by_joint[name], depth)
        raise NotComparable(f"a pose refers to `{name}`")

    def pose_of_joint(self, joint: Element, depth: int = 0) -> Array:
        return self.relative(joint, (joint.findtext("child") or "").strip(), depth)

    def relative(self, element: Element, default: str, depth: int) -> Array:
        pose = element.find("pose")
        named = None if pose is None else pose.get("relative_to") or pose.get("frame")
        return self.pose(named or default, depth + 1) @ pose_of(pose)


def load_of(axis: Element) -> tuple[float, float, float]:
    """Returns damping, stiffness and reference of an axis."""
    keys = ("damping", "spring_stiffness", "spring_reference")
    found = [axis.findtext(f"dynamics/{key}") for key in keys]
    damping, stiffness, reference = (float(text or 0.0) for text in found)
    return damping, stiffness, reference
