"""Measures the installed package; writes one line for each number.

The command is `python/target/venv/bin/python python/benchmarks/measure.py [--command pfaff] [--rust
loops]`. If the command and the program of `loops.rs` are given, the package is compared with both.
Each number is the minimum of several measurements. Loops and runs are measured in processor time of
all threads of a process, so the machine need not be idle. Imports and the first analysis are
measured in processor time and in wall time.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
ROBOT = ROOT / "crates" / "robot-trolley" / "robot-trolley.toml"
ANALYSES = 1000
RUNS = 20


def told(what: str, number: float, unit: str) -> None:
    """Writes a number."""
    sys.stdout.write(f"{what}: {number:.4g} {unit}\n")
    sys.stdout.flush()


def least(work: Callable[[], object], times: int = 5) -> float:
    """Returns the processor time (s) of this process for some work."""
    found = float("inf")
    for _ in range(times):
        begun = time.process_time()
        work()
        found = min(found, time.process_time() - begun)
    return found


def of_child(words: list[str | Path], times: int = 5) -> float:
    """Returns the processor time (s) of another program, from its start to its end."""
    found = float("inf")
    for _ in range(times):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([str(word) for word in words], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        found = min(found, used)
    return found


def fresh(before: str, code: str) -> tuple[float, float]:
    """Returns wall time and processor time (s) of some code in a new interpreter."""
    text = f"""
import time
{before}
wall, own = time.perf_counter(), time.process_time()
{code}
print(time.perf_counter() - wall, time.process_time() - own)
"""
    pairs = []
    for _ in range(9):
        words = [sys.executable, "-c", text]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        wall, own = map(float, done.stdout.split())
        pairs.append((wall, own))
    return min(wall for wall, _ in pairs), min(own for _, own in pairs)


WHEEL = """
scene = { name = "wheel", space = "plane" }
body = [{ name = "wheel", mass = 1.0, inertia = 0.4 }]
joint = [{ name = "shaft", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] }]
drive = [{ name = "motor", joint = "shaft", type = "angle", torque = "20 - 0.5*rate" }]
"""
T_END = 300.0


def of_functions() -> None:
    """Measures the time that a call of a function adds to a run."""
    import pfaff

    scene = pfaff.Scene.from_string(WHEEL)
    calls = 0

    def motor(t: float, angle: float, rate: float) -> float:
        nonlocal calls
        calls += 1
        return 20.0 - 0.5 * rate

    def idle(t: float, body: pfaff.BodyState) -> tuple[float, float, float]:
        nonlocal calls
        calls += 1
        return (0.0, 0.0, 0.0 * body.angular_velocity)

    def run(**functions: Any) -> tuple[float, int, int]:
        """Returns processor time, number of calls and number of evaluations of a run."""
        nonlocal calls
        calls, evaluations = 0, 0

        def go() -> None:
            nonlocal evaluations
            made = scene.simulate(
                T_END, rtol=1e-9, max_step=0.05, max_steps=10**6, output_step=T_END, method="dop853",
                reactions=False, **functions,
            )  # fmt: skip
            evaluations = made.document["evaluations"]

        spent = least(go, 5)
        return spent, calls // 5, evaluations

    text, _, evaluations = run()
    told("an evaluation of a wheel with a law as a text", 1e6 * text / evaluations, "us")
    for what, functions in (
        ("a call of a function of a drive", {"drives": {"motor": motor}}),
        ("a call of a function of a body", {"forces": {"wheel": idle}}),
    ):
        spent, made, _ = run(**functions)
        told(f"{what} adds ({made} calls in {spent:.2f} s)", 1e6 * (spent - text) / made, "us")


def main() -> None:
    """Performs all measurements."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", type=Path)
    parser.add_argument("--rust", type=Path)
    arguments = parser.parse_args()

    read = f"import pfaff; text = open({str(ROBOT)!r}, encoding='utf-8').read()"
    judge = "assert not pfaff.Scene.from_string(text).analyze().verdicts['W3'].unique"
    for what, before, code in (
        ("import numpy", "", "import numpy"),
        ("import, numpy included", "", "import pfaff"),
        ("import after numpy", "import numpy", "import pfaff"),
        ("first analysis of the robot from a string", read, judge),
    ):
        wall, own = fresh(before, code)
        told(what, 1e3 * wall, "ms")
        told(f"{what}, processor time", 1e3 * own, "ms")

    import pfaff

    of_functions()
    text = ROBOT.read_text(encoding="utf-8")
    scene = pfaff.Scene.from_string(text)

    def from_text() -> None:
        for _ in range(ANALYSES):
            assert not pfaff.Scene.from_string(text).analyze().verdicts["W3"].unique

    def from_scene() -> None:
        for _ in range(ANALYSES):
            assert not scene.analyze().verdicts["W3"].unique

    def documents() -> None:
        for _ in range(ANALYSES // 10):
            assert scene.analyze().document

    told(f"{ANALYSES} analyses from the text", least(from_text, 3), "s")
    told(f"{ANALYSES} analyses of a scene that was read", least(from_scene, 3), "s")
    told(f"{ANALYSES // 10} documents of such analyses", least(documents, 3), "s")
    if arguments.rust:
        for what in ("text", "read"):
            loop = [arguments.rust, ROBOT, what]
            spent = of_child([*loop, str(ANALYSES)], 3) - of_child([*loop, "0"], 3)
            told(f"Rust, {ANALYSES} analyses, {what}", spent, "s")

    def runs(reactions: bool) -> None:
        for _ in range(RUNS):
            assert len(pfaff.Scene.from_string(text).simulate(10.0, reactions=reactions)) > 200

    told("10 s of the robot with arrays", 1e3 * least(lambda: runs(True)) / RUNS, "ms")
    told("the same without reactions", 1e3 * least(lambda: runs(False)) / RUNS, "ms")
    if arguments.command:
        with TemporaryDirectory() as folder:
            quiet = Path(folder) / "robot.toml"
            body = text.split("[output]")[0]
            bare = of_child([arguments.command, "--version"], 9)
            for reactions in ("true", "false"):
                output = f"[output]\ntrajectory = false\nreactions = {reactions}\nreport = false\n"
                quiet.write_text(f"{body}\n{output}", encoding="utf-8")
                words = [arguments.command, "simulate", quiet, "--t-end", "10", "--force"]
                spent = of_child([*words, "--out", Path(folder) / "run"], 9) - bare
                told(f"the command without its start, reactions = {reactions}", 1e3 * spent, "ms")


if __name__ == "__main__":
    main()
