"""Uses pfaff as a program, with scene files of the same values and its own runs."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from mechanism import GROUND, Array, Body, Joint, Mechanism
from outcome import Outcome, Run

PROGRAM = str(Path(os.environ.get("PFAFF", "target/release/pfaff")).resolve())


def version() -> str:
    """Returns the version that the program prints."""
    shown = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True)
    return shown.stdout.split()[-1]


def numbers(values: Array, planar: bool) -> str:
    """Returns a vector in TOML; in the plane, only its first two components."""
    return "[" + ", ".join(repr(float(v)) for v in (values[:2] if planar else values)) + "]"


def body_text(body: Body, planar: bool) -> str:
    """Returns one `[[body]]`."""
    if planar:
        inertia, spin = repr(float(body.tensor[2, 2])), repr(float(body.angular_velocity[2]))
    else:
        inertia = "[" + ", ".join(numbers(row, False) for row in body.tensor) + "]"
        spin = numbers(body.angular_velocity, False)
    return (
        f'[[body]]\nname = "{body.name}"\nmass = {float(body.mass)!r}\ninertia = {inertia}\n'
        f"position = {numbers(body.centre, planar)}\nvelocity = {numbers(body.velocity, planar)}\n"
        f"angular_velocity = {spin}\n"
    )


def joint_text(joint: Joint, mechanism: Mechanism) -> str:
    """Returns one `[[joint]]`, with its axes in the frame of the first body."""
    names = [
        "ground" if k == GROUND else mechanism.bodies[k].name for k in (joint.first, joint.second)
    ]
    kind = "translational" if joint.kind == "prismatic" else joint.kind
    lines = [
        "[[joint]]",
        f'name = "{joint.name}"',
        f'type = "{kind}"',
        f'bodies = ["{names[0]}", "{names[1]}"]',
        f"at = {numbers(joint.at, mechanism.planar)}",
    ]
    if not mechanism.planar:
        if joint.axis is not None and joint.kind != "spherical":
            lines.append(f"axis = {numbers(joint.axis, False)}")
        if joint.cross is not None:
            lines.append(f"cross = {numbers(joint.cross, False)}")
    return "\n".join(lines) + "\n"


def scene_text(mechanism: Mechanism) -> str:
    """Returns the scene file, without reactions and page, because no other engine computes them."""
    planar = mechanism.planar
    parts = [
        f'[scene]\nname = "{mechanism.name}"\nspace = "{"plane" if planar else "spatial"}"\n'
        f"gravity = {numbers(mechanism.gravity, planar)}\n"
    ]
    parts += [body_text(body, planar) for body in mechanism.bodies]
    parts += [joint_text(joint, mechanism) for joint in mechanism.joints]
    for k, (body, offset) in enumerate(mechanism.watched):
        parts.append(
            f'[[marker]]\nname = "watched-{k}"\nbody = "{mechanism.bodies[body].name}"\n'
            f"point = {numbers(offset, planar)}\n"
        )
    parts.append(
        f"[simulate]\nt_end = {mechanism.duration!r}\noutput_step = {mechanism.interval!r}\n"
    )
    parts.append("[output]\nreactions = false\nreport = false\n")
    return "\n".join(parts)


def read_places(path: Path, mechanism: Mechanism) -> Array:
    """Reads the positions of the watched points after the start from `trajectory.csv`."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))[1:]
    axes = "xy" if mechanism.planar else "xyz"
    places = np.zeros((len(rows), len(mechanism.watched), 3))
    for i, row in enumerate(rows):
        for k in range(len(mechanism.watched)):
            places[i, k, : len(axes)] = [float(row[f"watched-{k}.{axis}"]) for axis in axes]
    return places


def prepare(mechanism: Mechanism, options: dict, step: float) -> Run:
    """Prepares a run with `step` as relative tolerance."""
    folder = tempfile.TemporaryDirectory(prefix="engines-")
    scene = Path(folder.name) / "scene.toml"
    scene.write_text(scene_text(mechanism))
    out = Path(folder.name) / "out"
    command = [PROGRAM, "simulate", str(scene), "--out", str(out), "--threads", "1"]
    command += ["--rtol", repr(step), "--atol", repr(step * 1e-2), *options.get("arguments", [])]

    def run() -> Outcome:
        with folder:
            begin = time.perf_counter()
            done = subprocess.run(command, capture_output=True, text=True)
            process = time.perf_counter() - begin
            summary = out / "summary.json"
            if not summary.exists():
                raise RuntimeError(done.stderr.strip()[-300:])
            document = json.loads(summary.read_text())
            places = read_places(out / "trajectory.csv", mechanism)
        note = (document["error"] or document["code"] or "") if document["partial"] else ""
        return Outcome(places, document["wall_seconds"], process, str(note)[:200])

    return run
