"""Compares accelerations of imported MJCF files with those of MuJoCo at random states."""

from __future__ import annotations

import argparse
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
OWN = sorted((ROOT / "crates/import/tests/all/mjcf").glob("*.xml"))
BOUND = 1e-9


def random_state(model: mujoco.MjModel, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Returns coordinates (angles in ±3, lengths in ±1 about the reference) and velocities."""
    q = model.qpos0.copy()
    for joint in range(model.njnt):
        at, kind = model.jnt_qposadr[joint], model.jnt_type[joint]
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            q[at : at + 3] += rng.uniform(-1, 1, 3)
            at += 3
        if kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL):
            turned = rng.normal(size=4)
            q[at : at + 4] = turned / np.linalg.norm(turned)
        elif kind == mujoco.mjtJoint.mjJNT_HINGE:
            q[at] = rng.uniform(-3, 3)
        else:
            q[at] += rng.uniform(-1, 1)
    return q, rng.uniform(-3, 3, model.nv)


def accelerations(model: mujoco.MjModel, q: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
    """Returns centre of mass, its acceleration, and angular acceleration by body, in ground axes."""
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(model, data)
    out = {}
    for body in range(1, model.nbody):
        jacobian, turning = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        rate, turning_rate = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        centre = data.xipos[body].copy()
        mujoco.mj_jac(model, data, jacobian, turning, centre, body)
        mujoco.mj_jacDot(model, data, rate, turning_rate, centre, body)
        linear = jacobian @ data.qacc + rate @ v
        angular = turning @ data.qacc + turning_rate @ v
        out[model.body(body).name] = np.concatenate([centre, linear, angular])
    return out


def parsed(text: str) -> dict[int, dict[str, np.ndarray]]:
    """Returns the lines of `imported_accelerations`."""
    out: dict[int, dict[str, np.ndarray]] = {}
    for line in text.splitlines():
        key, body, *numbers = line.split("\t")
        out.setdefault(int(key), {})[body] = np.array([float(x) for x in numbers])
    return out


def with_states(path: Path, states: list[tuple[np.ndarray, np.ndarray]]) -> Path:
    """Writes the file with these states as keyframes, next to its included files."""
    tree = ElementTree.parse(path)
    root = tree.getroot()
    for kind in ("keyframe", "equality"):
        for element in root.findall(kind):
            root.remove(element)
    keyframe = ElementTree.SubElement(root, "keyframe")
    for q, v in states:
        numbers = {"qpos": q, "qvel": v}
        ElementTree.SubElement(
            keyframe, "key", {k: " ".join(repr(float(x)) for x in n) for k, n in numbers.items()}
        )
    out = path.with_name(f"{path.stem}.states.tmp")
    tree.write(out)
    return out


def compare(path: Path, count: int, seed: int, program: str) -> tuple[float, int]:
    """Returns the largest relative difference of a file, and how many bodies were compared."""
    spec = mujoco.MjSpec.from_file(str(path))
    model = spec.compile()
    off = mujoco.mjtDisableBit
    for bit in ("CONTACT", "LIMIT", "FRICTIONLOSS", "EQUALITY", "ACTUATION"):
        model.opt.disableflags |= getattr(off, f"mjDSBL_{bit}")
    rng = np.random.default_rng(seed)
    states = [random_state(model, rng) for _ in range(count)]
    file = with_states(path, states)
    try:
        run = subprocess.run([program, str(file)], capture_output=True, text=True)
    finally:
        file.unlink()
    if run.returncode:
        raise SystemExit(f"{path.name}: {run.stderr}")
    ours = parsed(run.stdout)
    worst, bodies = 0.0, 0
    for number, (q, v) in enumerate(states):
        theirs = accelerations(model, q, v)
        shared = [name for name in theirs if name in ours.get(number, {})]
        if not shared:
            raise SystemExit(f"{path.name}: no body of state {number} is in both")
        bodies = len(shared)
        for name in shared:
            a, b = theirs[name], ours[number][name]
            # If other bodies were merged into a body, its centre of mass differs, so its spin is
            # compared.
            same = np.allclose(a[:3], b[:3], rtol=0, atol=1e-9)
            compared = slice(3, 9) if same else slice(6, 9)
            size = max(1.0, *(np.abs(x[3:]).max() for x in theirs.values()))
            worst = max(worst, np.abs(a - b)[compared].max() / size)
    return worst, bodies


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path, default=OWN)
    parser.add_argument("--states", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    program = ROOT / "target/release/examples/imported_accelerations"
    parser.add_argument("--program", default=str(program))
    arguments = parser.parse_args()
    print("| file | states | bodies | largest difference |\n| --- | --- | --- | --- |")
    failed = False
    for path in arguments.files:
        worst, bodies = compare(path, arguments.states, arguments.seed, arguments.program)
        failed |= not worst <= BOUND
        print(f"| {path.name} | {arguments.states} | {bodies} | {worst:.1e} |")
    sys.exit(failed)


if __name__ == "__main__":
    main()
