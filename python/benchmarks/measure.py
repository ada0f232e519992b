"""Measures the installed package; writes one line for each number.

`python/target/venv/bin/python python/benchmarks/measure.py [--command pfaff] [--rust loops]`: the
command and the program `examples/loops` are compared with if they are given. Each number is the
least of several.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
ROBOT = ROOT / "crates" / "robot-trolley" / "robot-trolley.toml"


def seconds(work: Callable[[], object], times: int = 5) -> float:
    """The least time of some."""
    least = float("inf")
    for _ in range(times):
        begun = time.perf_counter()
        work()
        least = min(least, time.perf_counter() - begun)
    return least


def told(what: str, number: float, unit: str) -> None:
    """Writes a number."""
    sys.stdout.write(f"{what}: {number:.4g} {unit}\n")


def fresh(code: str) -> float:
    """What a fresh interpreter says."""
    words = [sys.executable, "-c", code]
    least = float("inf")
    for _ in range(7):
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        least = min(least, float(done.stdout))
    return least


IMPORT = """
import time
{before}
begun = time.perf_counter()
import pfaff
print(time.perf_counter() - begun)
"""

FIRST = f"""
import time
import pfaff
text = open({str(ROBOT)!r}, encoding="utf-8").read()
begun = time.perf_counter()
assert not pfaff.Scene.from_string(text).analyze().verdicts["W3"].unique
print(time.perf_counter() - begun)
"""


def main() -> None:
    """All measurements."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", type=Path)
    parser.add_argument("--rust", type=Path)
    arguments = parser.parse_args()

    told("import, numpy included", 1e3 * fresh(IMPORT.format(before="")), "ms")
    told("import after numpy", 1e3 * fresh(IMPORT.format(before="import numpy")), "ms")
    told("first analysis of the robot from a string", 1e3 * fresh(FIRST), "ms")

    import pfaff

    text = ROBOT.read_text(encoding="utf-8")

    def analyses() -> None:
        for _ in range(1000):
            assert not pfaff.Scene.from_string(text).analyze().verdicts["W3"].unique

    scene = pfaff.Scene.from_string(text)

    def again() -> None:
        for _ in range(1000):
            assert not scene.analyze().verdicts["W3"].unique

    def documents() -> None:
        for _ in range(100):
            assert scene.analyze().document

    told("1000 analyses from the text", seconds(analyses, 3), "s")
    told("1000 analyses of a scene that was read", seconds(again, 3), "s")
    told("100 documents of such analyses", seconds(documents, 3), "s")
    if arguments.rust:
        for _ in range(3):
            done = subprocess.run([arguments.rust, ROBOT], capture_output=True, text=True, check=True)
            sys.stdout.write(done.stdout)

    def run() -> None:
        assert len(pfaff.Scene.from_string(text).simulate(10.0, choose="kept-rows"))

    def summary() -> None:
        assert len(pfaff.Scene.from_string(text).simulate(10.0, reactions=False))

    told("10 s of the robot with arrays", 1e3 * seconds(run), "ms")
    told("10 s of the robot with arrays, without reactions", 1e3 * seconds(summary), "ms")
    if arguments.command:
        with TemporaryDirectory() as folder:
            quiet = Path(folder) / "robot.toml"
            output = "\n[output]\ntrajectory = false\nreactions = {}\nreport = false\n"
            body = text.split("[output]")[0]
            for reactions in ("false", "true"):
                quiet.write_text(body + output.format(reactions), encoding="utf-8")
                words = [arguments.command, "simulate", quiet, "--t-end", "10", "--force", "--out"]

                def command() -> None:
                    done = [*words, Path(folder) / "run"]
                    subprocess.run(done, capture_output=True, check=True)

                told(f"the command, reactions = {reactions}", 1e3 * seconds(command), "ms")


if __name__ == "__main__":
    main()
