"""The report: tables at equal error, failures, and figures, from the rows of the measurement."""

from __future__ import annotations

import csv
import json
import math
import os
import platform
import statistics
import subprocess
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

import plans

ENGINES = ("pfaff", "exudyn", "mujoco", "drake", "pinocchio")
PACKAGES = {"exudyn": "exudyn", "mujoco": "mujoco", "drake": "drake", "pinocchio": "pin"}
TITLES = {
    "pfaff": "pfaff",
    "exudyn": "Exudyn",
    "mujoco": "MuJoCo",
    "drake": "Drake",
    "pinocchio": "Pinocchio",
}
IDLE = 0.5
"""Load of the machine up to which it counts as having no other work."""
RIGHT = 1e-2
"""Neighbours with a smaller error stayed on the branch; off it, errors are about 1 m."""


def machine() -> dict:
    """Returns the data of the machine on which the results depend."""
    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    program = os.environ.get("PFAFF", "target/release/pfaff")
    told = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
    commit = subprocess.run(
        ["git", "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=False
    )
    load = os.getloadavg()[0]
    return {
        "processor": f"{model}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        "versions": {"pfaff": told.stdout.strip().removeprefix("pfaff ")}
        | {name: version(package) for name, package in PACKAGES.items()},
        "commit": commit.stdout.strip(),
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "load at the start": round(load, 2),
    }


def check_machine(out: Path, is_fresh: bool) -> None:
    """Records the machine; rejects runs of another machine for the same table."""
    path = out / "machine.json"
    now = machine()
    if not is_fresh and path.exists():
        then = json.loads(path.read_text())
        for name in ("processor", "versions"):
            if then[name] != now[name]:
                raise SystemExit(f"the table is of another {name}; use --fresh")
        return
    path.write_text(json.dumps(now, indent=2, ensure_ascii=False) + "\n")


@dataclass
class Point:
    """One setting with one step: its runs over the rounds, and its neighbours."""

    step: float
    status: str
    error: float
    seconds: list[float] = field(default_factory=list)
    other: list[float] = field(default_factory=list)
    neighbours: list[float] = field(default_factory=list)
    note: str = ""
    reached: float = 0.0

    @property
    def median(self) -> float:
        """Returns the median time."""
        return statistics.median(self.seconds) if self.seconds else math.nan

    def fineness(self) -> float:
        """Returns a value that is larger for more steps (at least one) or a tighter tolerance."""
        return self.step if self.step >= 1.0 else 1.0 / self.step

    @property
    def is_done(self) -> bool:
        """Whether the run reached its end."""
        return self.status == "done"

    @property
    def right(self) -> int:
        """Returns the number of neighbours, including this run, that stayed on the branch."""
        return sum(error <= RIGHT for error in [*self.neighbours, self.error])

    @property
    def is_steady(self) -> bool:
        """Whether the run and all its neighbours stayed on the branch."""
        return self.right == len(self.neighbours) + 1


@dataclass
class Line:
    """A family on a problem, with its points from coarse to fine."""

    engine: str
    family: str
    points: list[Point]

    def done(self) -> list[Point]:
        """Returns the points whose run reached its end time."""
        return [point for point in self.points if point.is_done]

    def best(self) -> Point | None:
        """Returns the most accurate point."""
        return min(self.done(), key=lambda point: point.error, default=None)

    def chosen(self) -> Point | None:
        """Returns the cheapest point within the target with neighbours, otherwise the best one."""
        good = [point for point in self.done() if point.error <= plans.TARGET]
        tested = [point for point in good if point.neighbours] or good
        return min(tested, key=lambda point: point.median, default=None) or self.best()

    def cost(self) -> float:
        """Returns the time (s) at the target, interpolated between steps; nan if not reached.

        Points that were measured in all rounds take precedence over points that were measured once.
        """
        good = [point for point in self.done() if point.error <= plans.TARGET]
        rounds = max((len(point.seconds) for point in good), default=0)
        found = [point.median for point in good if len(point.seconds) == rounds]
        for coarse, fine in zip(self.points, self.points[1:], strict=False):
            if not (coarse.is_done and fine.is_done) or len(fine.seconds) < rounds:
                continue
            if fine.error <= plans.TARGET < coarse.error and len(coarse.seconds) == rounds:
                share = math.log(coarse.error / plans.TARGET) / math.log(coarse.error / fine.error)
                low, high = math.log(coarse.median), math.log(fine.median)
                found.append(math.exp(low + share * (high - low)))
        return min(found, default=math.nan)


Problem = tuple[str, int]


def read(path: Path) -> dict[Problem, list[Line]]:
    """Returns all lines of all problems."""
    points: dict[tuple, Point] = {}
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        key = (row["scene"], int(row["count"]), row["engine"], row["family"], row["step"])
        error = float(row["error"]) if row["error"] else math.inf
        if row["nearby"] != "0":
            if key in points:
                points[key].neighbours.append(error if row["status"] == "done" else math.inf)
            continue
        point = points.setdefault(
            key, Point(float(row["step"]), row["status"], error, note=row["note"])
        )
        point.reached = float(row["reached"] or 0.0)
        if row["seconds"]:
            point.seconds.append(float(row["seconds"]))
        if row["other_clock"]:
            point.other.append(float(row["other_clock"]))
    lines: dict[Problem, dict[tuple, Line]] = {}
    for (scene, count, engine, family, _), point in points.items():
        of_problem = lines.setdefault((scene, count), {})
        of_problem.setdefault((engine, family), Line(engine, family, [])).points.append(point)
    for of_problem in lines.values():
        for line in of_problem.values():
            line.points.sort(key=Point.fineness)
    return {problem: list(of_problem.values()) for problem, of_problem in lines.items()}


def with_models_of_space(lines: dict[Problem, list[Line]], problem: Problem) -> list[Line]:
    """Returns the lines of a problem; in the plane, peers with models in space are included."""
    listed = list(lines.get(problem, []))
    if problem[0] == "n-four-bar-plane":
        listed += [
            line
            for line in lines.get(("n-four-bar-space", problem[1]), [])
            if line.engine != "pfaff"
        ]
    return listed


def fastest(lines: list[Line], engine: str, is_steady: bool) -> Line | None:
    """Returns the family of an engine with the lowest cost at the target."""
    reached = [line for line in lines if line.engine == engine and not math.isnan(line.cost())]
    if is_steady:
        reached = [line for line in reached if line.chosen().is_steady]
    return min(reached, key=Line.cost, default=None)


def milliseconds(seconds: float) -> str:
    """Returns a time with two or three digits."""
    value = 1e3 * seconds
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def ratio(value: float) -> str:
    """Returns a ratio with two digits."""
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}"


def cell(lines: list[Line], engine: str) -> str:
    """Returns the cost of an engine on a problem, or the smallest error that it reached."""
    of_engine = [line for line in lines if line.engine == engine]
    if not of_engine:
        return "–"
    line = fastest(of_engine, engine, True) or fastest(of_engine, engine, False)
    if line:
        unsteady = "" if line.chosen().is_steady else " (not steady)"
        return milliseconds(line.cost()) + unsteady
    best = min(
        (found for line in of_engine if (found := line.best())),
        key=lambda point: point.error,
        default=None,
    )
    if best is None:
        return "no run ends"
    return f"not reached: {best.error:.0e} in {milliseconds(best.median)}"


def alone(lines: list[Line]) -> str:
    """Returns the time of Pinocchio's accelerations alone within its fastest steady setting."""
    line = fastest(lines, "pinocchio", True) or fastest(lines, "pinocchio", False)
    if line is None or not line.chosen().other:
        return "–"
    point = line.chosen()
    return milliseconds(line.cost() * statistics.median(point.other) / point.median)


def cost_table(lines: dict[Problem, list[Line]], problems: list[Problem]) -> str:
    """Returns the milliseconds at the target, with one column for each engine."""
    titles = [*(TITLES[name] for name in ENGINES), "its accelerations alone"]
    text = "| scene | N | " + " | ".join(titles) + " |\n"
    text += "| --- | ---: |" + " ---: |" * len(titles) + "\n"
    for problem in problems:
        listed = with_models_of_space(lines, problem)
        cells = " | ".join(cell(listed, engine) for engine in ENGINES)
        text += f"| {problem[0]} | {problem[1]} | {cells} | {alone(listed)} |\n"
    return text


def steady_text(point: Point) -> str:
    """Returns how many of the neighbours stayed on the branch."""
    return f"{point.right} of {len(point.neighbours) + 1}"


def loops_table(lines: dict[Problem, list[Line]]) -> str:
    """Compares pfaff in space on the n-four-bar with pfaff in the plane and the fastest peer."""
    text = (
        "| | N | pfaff, ms | error | right branch | tolerances | whole process, ms | "
        "space : plane | fastest steady peer | its ms | right branch | peer : pfaff |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: |\n"
    )
    for count in plans.LARGE:
        for scene in plans.LOOPS:
            listed = with_models_of_space(lines, (scene, count))
            own = fastest(listed, "pfaff", False)
            if own is None:
                continue
            peers = [line for name in ENGINES[1:] if (line := fastest(listed, name, True))]
            peer = min(peers, key=Line.cost, default=None)
            plane = fastest(lines.get(("n-four-bar-plane", count), []), "pfaff", False)
            of_plane = ratio(own.cost() / plane.cost()) if "space" in scene and plane else ""
            point = own.chosen()
            text += (
                f"| {scene.split('-')[-1]} | {count} | {milliseconds(own.cost())} | "
                f"{point.error:.0e} | {steady_text(point)} | "
                f"{len(own.done())} of {len(own.points)} | "
                f"{milliseconds(statistics.median(point.other))} | {of_plane} | "
            )
            if peer:
                text += (
                    f"{TITLES[peer.engine]}, {peer.family} | {milliseconds(peer.cost())} | "
                    f"{steady_text(peer.chosen())} | "
                    f"**{ratio(peer.cost() / own.cost())}** |\n"
                )
            else:
                text += "none | | | |\n"
    return text


def setting_table(lines: dict[Problem, list[Line]], problems: list[Problem]) -> str:
    """Returns all families of all problems."""
    text = (
        "| scene | N | engine | setting | ms at the target | best error | in ms | "
        "right branch | how it ended |\n"
        "| --- | ---: | --- | --- | ---: | ---: | ---: | ---: | --- |\n"
    )
    for problem in problems:
        for line in sorted(lines.get(problem, []), key=lambda x: ENGINES.index(x.engine)):
            best, chosen = line.best(), line.chosen()
            cost = line.cost()
            shown = "" if math.isnan(cost) else milliseconds(cost)
            error = f"{best.error:.1e}" if best else "–"
            time = milliseconds(best.median) if best else "–"
            branch = steady_text(chosen) if chosen and chosen.neighbours else ""
            text += (
                f"| {problem[0]} | {problem[1]} | {TITLES[line.engine]} | {line.family} | "
                f"{shown} | {error} | {time} | {branch} | {ending(line)} |\n"
            )
    return text


def ending(line: Line) -> str:
    """Returns the reason why a line did not reach its end, in words."""
    parts = []
    for status, words in (
        ("refused", "refused"),
        ("crashed", "crashed"),
        ("timeout", "time-out"),
        ("stopped", "stopped"),
    ):
        found = [point for point in line.points if point.status == status]
        if found:
            note = found[-1].note.replace("|", "/")[:110]
            parts.append(
                f"{words} {len(found)} of {len(line.points)}" + (f": {note}" if note else "")
            )
    wrong = [point for point in line.done() if point.error > 0.1]
    if wrong:
        parts.append(f"off by more than 0.1 m {len(wrong)} of {len(line.points)}")
    return "; ".join(parts)


def losses(lines: dict[Problem, list[Line]], problems: list[Problem]) -> str:
    """Returns the cases in which a peer is faster than pfaff, or less than 20 times slower."""
    items = []
    for problem in problems:
        listed = with_models_of_space(lines, problem)
        own = fastest(listed, "pfaff", False)
        near = []
        for name in ENGINES[1:]:
            peer = fastest(listed, name, True)
            if own and peer and peer.cost() < 20.0 * own.cost():
                times = peer.cost() / own.cost()
                near.append((times, f"{TITLES[name]} ({peer.family}) {ratio(times)}"))
        if near:
            words = ", ".join(text for _, text in sorted(near))
            mark = " **pfaff is slower.**" if min(near)[0] < 1.0 else ""
            items.append(f"- {problem[0]}, N = {problem[1]}: {words}.{mark}")
    return "\n".join(items) or "- Nowhere."


def ordered(lines: dict[Problem, list[Line]]) -> list[Problem]:
    """Returns the problems that were measured, in the order of the plan."""
    return [problem for problem in plans.problems(quick=False) if problem in lines]


def machine_table(out: Path) -> str:
    """Returns a description of the machine."""
    told = json.loads((out / "machine.json").read_text())
    versions = ", ".join(f"{TITLES[name]} {text}" for name, text in told["versions"].items())
    text = (
        f"{told['processor']}; {told['system']}; {versions}; sources of commit {told['commit']}; "
        f"{told['date']}; load of the machine at the start {told['load at the start']}."
    )
    if told["load at the start"] > IDLE:
        text += " **If this load indicates other work on the machine, times are provisional and ratios are approximate.**"
    return text


def write(out: Path) -> None:
    """Writes `README.md` and the figures."""
    import figures

    lines = read(out / "engines.csv")
    problems = ordered(lines)
    template = (Path(__file__).parent / "report.md").read_text()
    settings = "# Every setting on every scene\n\nMade by `tests/peers/engines/run.py`; the words "
    settings += "are those of [the report](README.md).\n\n" + setting_table(lines, problems)
    (out / "settings.md").write_text(settings)
    parts = {
        "machine": machine_table(out),
        "loops": loops_table(lines),
        "costs": cost_table(lines, problems),
        "losses": losses(lines, problems),
        "rounds": str(max(len(p.seconds) for of in lines.values() for x in of for p in x.points)),
    }
    for name, text in parts.items():
        template = template.replace("{" + name + "}", text.strip())
    (out / "README.md").write_text(template)
    figures.draw(out, lines, problems)
