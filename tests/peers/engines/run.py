"""Compares engines of mechanics and writes the report.

usage: python tests/peers/engines/run.py --out docs/reports/engines [--quick] [--fresh]

Runs that are already in the table are not repeated, so an interrupted measurement is resumed. The
sweeps come first. Then the selected runs are repeated in rounds over all engines, so that other
work of the machine affects all engines equally. The neighbours of the chosen runs come last.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import queue
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import plans
import report
from plans import Family

HERE = Path(__file__).resolve().parent
COLUMNS = [
    "scene",
    "count",
    "engine",
    "family",
    "step",
    "nearby",
    "round",
    "status",
    "seconds",
    "other_clock",
    "error",
    "reached",
    "note",
]
BUILD_LIMIT = 60.0
RUN_LIMIT = 20.0
PATIENCE = 8.0
"""A step that would take longer than this is not tried (s)."""
SETTLED = 1e-7
"""Tolerance up to which runs that do not improve on looser ones are no reason to stop."""

LOST = 3
"""Neighbours off the branch after which the others are not run."""
NEIGHBOURS = [-1, 1, -2, 2, -3, 3, -4, 4, -5, 5, -6, 6, -7, 7, -8, 8]
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}


class Worker:
    """A process with one engine, restarted after a crash or a time-out."""

    def __init__(self, engine: str, core: int) -> None:
        """Does not start the process yet."""
        self.engine, self.core = engine, core
        self.process: subprocess.Popen | None = None
        self.lines: queue.Queue = queue.Queue()
        self.version = "does not start"

    def start(self) -> None:
        """Starts the process and receives the version of its engine."""
        command = [sys.executable, str(HERE / "worker.py"), self.engine, str(self.core)]
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | ONE_THREAD,
        )
        self.lines = queue.Queue()
        threading.Thread(target=self.listen, args=(self.process, self.lines), daemon=True).start()
        told = self.read(BUILD_LIMIT)
        if told and "version" in told:
            self.version = told["version"]

    @staticmethod
    def listen(process: subprocess.Popen, lines: queue.Queue) -> None:
        """Passes on the output of a process; None at its end."""
        for line in process.stdout:
            lines.put(json.loads(line))
        lines.put(None)

    def read(self, limit: float) -> dict | None:
        """Returns the next answer; None if the process ended, {} if it took too long."""
        try:
            return self.lines.get(timeout=limit)
        except queue.Empty:
            return {}

    def stop(self) -> None:
        """Ends the process."""
        if self.process:
            self.process.kill()
            self.process.wait()
        self.process = None

    def ask(self, order: dict) -> dict:
        """Executes an order; a crash or a time-out also gives a row."""
        if self.process is None:
            self.start()
        try:
            self.process.stdin.write(json.dumps(order) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            self.stop()
            return {"status": "crashed", "note": "the engine does not start"}
        told = self.read(BUILD_LIMIT)
        phase, limit = "building the model", BUILD_LIMIT
        if told and "ready" in told:
            told = self.read(RUN_LIMIT)
            phase, limit = "running", RUN_LIMIT
        if told is None:
            code = self.process.wait()
            self.stop()
            return {"status": "crashed", "note": f"exit {code} while {phase}"}
        if told == {}:
            self.stop()
            return {"status": "timeout", "seconds": limit, "note": f"{limit:.0f} s while {phase}"}
        return told


@dataclass
class Table:
    """All rows, in a file to which each run appends one line."""

    path: Path
    rows: dict[tuple, dict] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Reads the existing rows."""
        if self.path.exists():
            with self.path.open(newline="") as file:
                for row in csv.DictReader(file):
                    self.rows[self.key(row)] = row
        else:
            with self.path.open("w", newline="") as file:
                csv.DictWriter(file, COLUMNS, lineterminator="\n").writeheader()

    @staticmethod
    def key(row: dict) -> tuple:
        """Returns the properties that identify a run."""
        return (
            row["scene"],
            int(row["count"]),
            row["engine"],
            row["family"],
            f"{float(row['step']):.6g}",
            int(row["nearby"]),
            int(row["round"]),
        )

    def add(self, row: dict) -> dict:
        """Adds a row."""
        text = {name: shown(row.get(name)) for name in COLUMNS}
        self.rows[self.key(text)] = text
        with self.path.open("a", newline="") as file:
            csv.DictWriter(file, COLUMNS, lineterminator="\n").writerow(text)
        return text


def shown(value: object) -> str:
    """Returns a cell of the table."""
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Measurement:
    """The whole measurement: workers, table, and the choice of the next runs."""

    def __init__(self, table: Table, core: int, rounds: int) -> None:
        """Does not start any run."""
        self.table, self.core, self.rounds = table, core, rounds
        self.workers: dict[str, Worker] = {}

    def run(
        self, problem: tuple[str, int], family: Family, step: float, nearby: int = 0, turn: int = 1
    ) -> dict:
        """Performs one run, or returns its row if the row exists."""
        scene, count = problem
        row = {
            "scene": scene,
            "count": count,
            "engine": family.engine,
            "family": family.name,
            "step": step,
            "nearby": nearby,
            "round": turn,
        }
        known = self.table.rows.get(Table.key(row))
        if known:
            return known
        worker = self.workers.setdefault(family.engine, Worker(family.engine, self.core))
        order = {
            "scene": scene,
            "count": count,
            "nearby": nearby,
            "options": family.options,
            "step": step,
            "is_tolerance": family.is_tolerance,
        }
        row |= worker.ask(order)
        told = self.table.add(row)
        print(" ".join(told[name] or "-" for name in COLUMNS), flush=True)
        return told

    def sweep(self, problem: tuple[str, int]) -> None:
        """Runs each family from coarse to fine, until it is accurate, slow, or at its best."""
        for family in plans.families(*problem):
            best, worse, failed, last = float("inf"), 0, 0, 0.0
            for step in family.steps:
                expected = last * (1.3 if family.is_tolerance else 2.0)
                if expected > (1.0 if best <= plans.TARGET else PATIENCE):
                    break
                row = self.run(problem, family, step)
                if row["status"] in ("timeout", "crashed"):
                    # A tighter tolerance may succeed after a failure of a looser one. A smaller
                    # step takes longer, and so does a run that did not reach its end with the
                    # coarsest step.
                    failed += 1
                    if failed == LOST or best == float("inf") or not family.is_tolerance:
                        break
                    continue
                error = float("inf")
                if row["status"] == "done":
                    last, error = float(row["seconds"]), float(row["error"])
                worse = 0 if error < 0.8 * best else worse + 1
                best = min(best, error)
                # An error at a loose tolerance may be small by coincidence.
                is_early = family.is_tolerance and step > SETTLED
                if best < plans.FINE or (
                    not is_early and worse >= (3 if best < float("inf") else 6)
                ):
                    break

    def chosen(self, problem: tuple[str, int]) -> list[tuple[Family, float, float]]:
        """Returns step and time (s) of the cheapest run of each family, or of its best.

        Families within the target come first; each group is in the order of cost.
        """
        picked = []
        for family in plans.families(*problem):
            runs = [
                self.table.rows.get(
                    Table.key(
                        {
                            "scene": problem[0],
                            "count": problem[1],
                            "engine": family.engine,
                            "family": family.name,
                            "step": step,
                            "nearby": 0,
                            "round": 1,
                        }
                    )
                )
                for step in family.steps
            ]
            done = [row for row in runs if row and row["status"] == "done"]
            good = [row for row in done if float(row["error"]) <= plans.TARGET]
            row = min(good, key=lambda r: float(r["seconds"]), default=None) or min(
                done, key=lambda r: float(r["error"]), default=None
            )
            if row:
                is_far = float(row["error"]) > plans.TARGET
                picked.append((is_far, float(row["seconds"]), float(row["step"]), family))
        picked.sort(key=lambda one: one[:2])
        return [(family, step, seconds) for _, seconds, step, family in picked]

    def repeat(self, problem: tuple[str, int]) -> None:
        """Performs further rounds, interleaved: of chosen runs, and of all short runs."""
        again = {}
        seen = set()
        for family, step, seconds in self.chosen(problem):
            if seconds <= 6.0 and family.engine not in seen:
                at = [f"{one:.6g}" for one in family.steps].index(f"{step:.6g}")
                # The next coarser step is included, to interpolate between both.
                for one in family.steps[max(0, at - 1) : at + 1]:
                    again[family.engine, family.name, one] = family
            seen.add(family.engine)
        for family in plans.families(*problem):
            for step in family.steps:
                key = Table.key(
                    {
                        "scene": problem[0],
                        "count": problem[1],
                        "engine": family.engine,
                        "family": family.name,
                        "step": step,
                        "nearby": 0,
                        "round": 1,
                    }
                )
                row = self.table.rows.get(key)
                if row and row["status"] == "done" and float(row["seconds"]) <= 0.1:
                    again[family.engine, family.name, step] = family
        for turn in range(2, self.rounds + 1):
            for (_, _, step), family in again.items():
                self.run(problem, family, step, turn=turn)

    def neighbours(self, problem: tuple[str, int]) -> None:
        """Runs nearby starts and steps of the n-four-bar, for the best family of each engine.

        Families are tried in the order of their cost until all neighbours of one stay on the
        branch. Long runs have fewer neighbours.
        """
        by_engine: dict[str, list[tuple[Family, float, float]]] = {}
        for family, step, seconds in self.chosen(problem):
            by_engine.setdefault(family.engine, []).append((family, step, seconds))
        for picked in by_engine.values():
            for family, step, seconds in picked:
                allowed = max(1, min(16, int(24.0 / max(seconds, 1e-3))))
                lost = 0
                for nearby in NEIGHBOURS[:: -(-16 // allowed)]:
                    row = self.run(problem, family, step, nearby=nearby)
                    lost += row["status"] != "done" or float(row["error"]) > report.RIGHT
                    if lost == LOST:
                        break
                if lost == 0:
                    break

    def all(self, quick: bool) -> None:
        """Measures everything, problem by problem."""
        for problem in plans.problems(quick):
            self.sweep(problem)
            self.repeat(problem)
            if problem[0] in (*plans.LOOPS, plans.THIN):
                self.neighbours(problem)
        for worker in self.workers.values():
            worker.stop()


def write_scenes(folder: Path) -> None:
    """Writes the scene files of the small problems in the format of pfaff."""
    import scenes
    from with_pfaff import scene_text

    folder.mkdir(exist_ok=True)
    for scene, count in plans.problems(quick=True):
        made = scenes.make(scene, count)
        (folder / f"{made.name}.toml").write_text(scene_text(made))


def main() -> None:
    """Reads the command line and performs the measurement."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of the report")
    parser.add_argument("--quick", action="store_true", help="small scenes, two rounds")
    parser.add_argument("--fresh", action="store_true", help="forget the runs that are there")
    parser.add_argument("--pfaff", type=Path, help="the program; default: PFAFF, target/release")
    parser.add_argument("--core", type=int, default=0, help="the core that all runs are tied to")
    parser.add_argument("--rounds", type=int, default=5, help="repetitions of what counts")
    parser.add_argument("--only-report", action="store_true", help="write the report again")
    given = parser.parse_args()
    if given.pfaff:
        os.environ["PFAFF"] = str(given.pfaff.resolve())
    given.out.mkdir(parents=True, exist_ok=True)
    table_path = given.out / "engines.csv"
    if given.fresh:
        table_path.unlink(missing_ok=True)
    begin = time.perf_counter()
    if not given.only_report:
        write_scenes(HERE / "scenes")
        report.check_machine(given.out, given.fresh or not table_path.exists())
        measurement = Measurement(Table(table_path), given.core, 2 if given.quick else given.rounds)
        measurement.all(given.quick)
    report.write(given.out)
    print(f"{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
