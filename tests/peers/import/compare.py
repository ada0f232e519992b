"""Compares accelerations of imported MJCF files with those of MuJoCo at random states."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np

import reference

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
OWN = sorted((ROOT / "crates/import/tests/all/mjcf").glob("*.xml"))
BOUND = 1e-9


def compare(path: Path, count: int, seed: int, program: str) -> tuple[float, int]:
    """Returns the largest relative difference of a file, and how many bodies were compared."""
    model = reference.load(path)
    states = reference.states(model, count, np.random.default_rng(seed))
    # Included files are relative to the file, so the copy is beside it.
    file = path.with_name(f"{path.stem}.states.tmp")
    file.write_text(reference.with_keyframes(path.read_text(), states))
    try:
        run = subprocess.run([program, str(file)], capture_output=True, text=True, check=False)
    finally:
        file.unlink()
    if run.returncode:
        raise SystemExit(f"{path.name}: {run.stderr}")
    ours = reference.parsed(run.stdout)
    worst = 0.0
    for number, state in enumerate(states):
        theirs = reference.accelerations(model, state)
        worst = max(worst, reference.largest_difference(theirs, ours.get(number, {})))
    return worst, len(reference.groups(model))


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
