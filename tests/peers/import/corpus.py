"""Imports, analyses and simulates the public models of `models.txt`, and compares with MuJoCo.

Nothing of the models is part of the workspace: `--fetch` downloads them.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import resource
import signal
import subprocess
import sys
from collections import Counter
from dataclasses import asdict, dataclass, fields
from multiprocessing import Process
from multiprocessing.connection import wait
from pathlib import Path, PurePosixPath

import numpy as np
import yaml

import reference
from sdf_reference import load_sdf

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]

# The list, so that a shorter list is not mistaken for a result.
LEAST_MODELS = 300
# Below this share, users cannot expect that the import reads their file.
LEAST_IMPORTED = 0.55
# Above this share, the comparison says little about the import.
MOST_NOT_COMPARABLE = 0.30
# Both sides compute with doubles and solve systems whose condition is up to about 1e6.
BOUND = 1e-9
# Processor time of one command. A model that needs more counts as too slow.
SECONDS = 60
DURATION = 0.1
STATES = 3
SEED = 1


@dataclass
class Entry:
    """A line of the list."""

    format: str
    repository: str
    commit: str
    licence: str
    path: str
    loops: str

    @property
    def name(self) -> str:
        return f"{self.repository}/{self.path}"

    def clone(self, folder: Path) -> Path:
        return folder / f"{self.repository}.git"

    def file(self, folder: Path) -> Path:
        return folder / "files" / self.repository / self.path

    def work(self, folder: Path) -> Path:
        return folder / "scenes" / self.repository / self.path

    def result_file(self, folder: Path) -> Path:
        return self.work(folder) / "result.json"

    def loops_file(self, folder: Path) -> Path | None:
        return folder / "files" / self.repository / self.loops if self.loops else None


@dataclass
class Result:
    """What came out for one model. Texts are "ok" or the reason."""

    format: str
    repository: str
    path: str
    imported: str = ""
    analysed: str = ""
    simulated: str = ""
    accelerations: str = ""
    difference: float | None = None
    rank: str = ""
    seconds: float = 0.0


def entries(list_file: Path) -> list[Entry]:
    out = []
    for line in list_file.read_text().splitlines():
        columns = line.split("\t")
        out.append(Entry(*columns, *[""] * (len(fields(Entry)) - len(columns))))
    return out


# Fetching


def fetch(entry: Entry, folder: Path, mirror: Path | None) -> None:
    """Writes the file of an entry, the files that it includes, and its loops."""
    clone = entry.clone(mirror) if mirror else commit_of(entry, folder / "clones")
    pending, seen = [entry.path, *([entry.loops] if entry.loops else [])], set()
    while pending:
        path = pending.pop()
        text = content(clone, entry.commit, path)
        seen.add(path)
        if text is None:
            if path == entry.path:
                sys.exit(f"{entry.repository} has no {path} at {entry.commit}")
            continue
        target = folder / "files" / entry.repository / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(text)
        pending += [p for p in included(entry, path, text) if p not in seen]


def commit_of(entry: Entry, clones: Path) -> Path:
    """Fetches one commit without the contents of its files. Git fetches these on demand."""
    clone = entry.clone(clones)
    if not clone.is_dir():
        clone.parent.mkdir(parents=True, exist_ok=True)
        url = f"https://github.com/{entry.repository}"
        git(clone.parent, "init", "--quiet", "--bare", clone.name)
        git(clone, "remote", "add", "origin", url)
    if git(clone, "cat-file", "-e", entry.commit) is None:
        one = ("--quiet", "--depth=1", "--filter=blob:none", "origin", entry.commit)
        if git(clone, "fetch", *one) is None:
            sys.exit(f"{entry.repository}: cannot fetch {entry.commit}")
    return clone


def content(clone: Path, commit: str, path: str) -> bytes | None:
    return git(clone, "cat-file", "blob", f"{commit}:{path}")


def git(folder: Path, *arguments: str) -> bytes | None:
    run = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, check=False)
    return run.stdout if run.returncode == 0 else None


def included(entry: Entry, path: str, text: bytes) -> list[str]:
    """Returns paths of included files, relative to the file and to the main file."""
    if entry.format != "mjcf" or not path.endswith((".xml", ".mjcf")):
        return []
    words = re.findall(
        r"<\s*(?:include|model)\b[^>]*\bfile\s*=\s*[\"']([^\"']+)", text.decode(errors="replace")
    )
    bases = {PurePosixPath(path).parent, PurePosixPath(entry.path).parent}
    paths = {os.path.normpath(base / word) for base in bases for word in words}
    return sorted(p for p in paths if not p.startswith(("..", "/")))


# One model


@dataclass
class Programs:
    pfaff: str
    accelerations: str


def examine(entry: Entry, folder: Path, programs: Programs) -> Result:
    result = Result(entry.format, entry.repository, entry.path)
    scene = entry.work(folder) / "scene.toml"
    importing = [programs.pfaff, "import", str(entry.file(folder)), "--json", "--force"]
    loops = entry.loops_file(folder)
    if loops:
        importing += ["--loops", str(loops)]
    result.imported, _ = run_json([*importing, "--out", str(scene)])
    if result.imported == "ok":
        question(result, entry, folder, programs, scene)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    result.seconds = round(used.ru_utime + used.ru_stime, 2)
    return result


def question(result: Result, entry: Entry, folder: Path, programs: Programs, scene: Path) -> None:
    result.analysed, analysis = run_json([programs.pfaff, "analyze", str(scene), "--json"])
    run = scene.with_name("run.toml")
    run.write_text(scene.read_text() + "\n[output]\nreactions = false\nreport = false\n")
    out = ["--out", str(scene.with_name("out")), "--force", "--t-end", str(DURATION)]
    result.simulated, _ = run_json([programs.pfaff, "simulate", str(run), "--json", *out])
    try:
        result.rank = compare_ranks(model_of(entry, folder, False), result, analysis)
    except reference.NotComparable as reason:
        result.rank = f"not comparable: {reason}"
    try:
        model = model_of(entry, folder)
        result.difference = compare_accelerations(model, entry, folder, programs, scene)
        is_close = result.difference <= BOUND
        result.accelerations = "ok" if is_close else f"differ by {result.difference:.1e}"
    except reference.NotComparable as reason:
        result.accelerations = f"not comparable: {reason}"
    except reference.Differs as reason:
        result.accelerations = f"differ: {reason}"


def model_of(entry: Entry, folder: Path, has_masses: bool = True) -> reference.mujoco.MjModel:
    file, loops = entry.file(folder), entry.loops_file(folder)
    if entry.format == "sdf":
        return load_sdf(file, has_masses)
    return reference.load(file, loops_of(loops) if loops else None, has_masses)


def loops_of(file: Path) -> reference.Loops:
    content = yaml.safe_load(file.read_text())
    pairs = zip(content.get("closed_loop", []), content.get("type", []), strict=True)
    joints = zip(content.get("joint_name", []), content.get("joint_type", []), strict=True)
    return reference.Loops([(a, b, kind.lower()) for (a, b), kind in pairs], list(joints))


def compare_ranks(
    model: reference.mujoco.MjModel, result: Result, analysis: dict[str, object]
) -> str:
    """Compares redundancy and mobility. Joints of the tree have independent rows."""
    if result.analysed != "ok":
        raise reference.NotComparable(f"analyze: {result.analysed}")
    rows, rank = reference.rank(model)
    theirs = (rows - rank, model.nv - rank)
    ours = (analysis["redundancy"], analysis["mobility"])
    if ours == theirs:
        return "ok"
    return f"redundancy and mobility {ours}, MuJoCo {theirs}"


def compare_accelerations(
    model: reference.mujoco.MjModel,
    entry: Entry,
    folder: Path,
    programs: Programs,
    scene: Path,
) -> float:
    chosen = reference.states(model, STATES, np.random.default_rng(SEED))
    if not reference.groups(model):
        raise reference.NotComparable("no body with mass moves")
    ours = our_accelerations(model, chosen, entry, folder, programs, scene)
    worst = 0.0
    for number, state in enumerate(chosen):
        theirs = reference.accelerations(model, state)
        worst = max(worst, reference.largest_difference(theirs, ours.get(number, {})))
    return worst


def our_accelerations(
    model: reference.mujoco.MjModel,
    chosen: list[reference.State],
    entry: Entry,
    folder: Path,
    programs: Programs,
    scene: Path,
) -> dict[int, dict[str, reference.Motion]]:
    if entry.format == "mjcf":
        # Included files are relative to the file, so the copy is beside it.
        file = entry.file(folder)
        copy = file.with_name(f"{file.stem}.states.tmp")
        copy.write_text(reference.with_keyframes(file.read_text(), chosen))
        return accelerations_of(copy, programs)
    out = {}
    for number, state in enumerate(chosen):
        copy = scene.with_name(f"state-{number}.toml")
        copy.write_text(reference.with_start(scene.read_text(), model, state))
        out[number] = accelerations_of(copy, programs)[0]
    return out


def accelerations_of(file: Path, programs: Programs) -> dict[int, dict[str, reference.Motion]]:
    done = run([programs.accelerations, str(file)])
    if is_slow(done):
        raise reference.NotComparable("accelerations take too long")
    if done.returncode:
        reason = done.stderr.strip().splitlines()[:1]
        raise reference.Differs(f"the scene at a state is rejected: {''.join(reason)[:400]}")
    return reference.parsed(done.stdout)


def run(command: list[str]) -> subprocess.CompletedProcess[str]:
    """Runs a command with a limit of processor time, which other programs do not influence."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))

    return subprocess.run(command, capture_output=True, text=True, preexec_fn=limit, check=False)


def is_slow(done: subprocess.CompletedProcess[str]) -> bool:
    return done.returncode in (-signal.SIGXCPU, -signal.SIGKILL)


def run_json(command: list[str]) -> tuple[str, dict[str, object]]:
    """Runs a command. Returns "ok", or the code and the message of a refusal, or what failed."""
    done = run(command)
    if is_slow(done):
        return "too slow", {}
    try:
        answer = json.loads(done.stdout)
    except json.JSONDecodeError:
        return f"crash: exit code {done.returncode}: {done.stderr.strip()[-300:]}", {}
    if done.returncode == 0:
        return "ok", answer
    code, error = answer.get("code"), answer.get("error")
    if done.returncode in (1, 2) and re.fullmatch(r"P\d{4}", code or ""):
        problems = answer.get("problems") or [{}]
        return f"{code} {problems[0].get('message') or error}", answer
    return f"crash: exit code {done.returncode}, code {code}: {error}", answer


# All models


def examine_all(chosen: list[Entry], folder: Path, programs: Programs, jobs: int) -> list[Result]:
    """Examines each model in its own process, because MuJoCo ends its process on some errors."""
    waiting, running = chosen[::-1], {}
    exit_codes: dict[str, int | None] = {}
    while waiting or running:
        while waiting and len(running) < jobs:
            entry = waiting.pop()
            entry.work(folder).mkdir(parents=True, exist_ok=True)
            process = Process(target=write_result, args=(entry, folder, programs))
            process.start()
            running[process.sentinel] = (process, entry)
        for sentinel in wait(list(running)):
            process, entry = running.pop(sentinel)
            process.join()
            exit_codes[entry.name] = process.exitcode
    return [result_of(entry, folder, exit_codes[entry.name]) for entry in chosen]


def result_of(entry: Entry, folder: Path, exit_code: int | None) -> Result:
    if exit_code:
        words = f"crash: the process of the script ends with exit code {exit_code}"
        return Result(entry.format, entry.repository, entry.path, imported=words)
    return Result(**json.loads(entry.result_file(folder).read_text()))


def write_result(entry: Entry, folder: Path, programs: Programs) -> None:
    result = examine(entry, folder, programs)
    entry.result_file(folder).write_text(json.dumps(asdict(result)))


def kind_of(text: str) -> str:
    """Returns a reason without names and numbers, so that equal reasons are counted together."""
    return re.sub(r"`[^`]*`|'[^']*'|\"[^\"]*\"", "…", re.sub(r"-?\d[\d.e+-]*", "#", text[5:]))


def report(results: list[Result]) -> bool:
    """Prints counts and reasons. Returns whether every number is reached."""
    imported = [r for r in results if r.imported == "ok"]
    for name in ("imported", "analysed", "simulated", "accelerations", "rank"):
        asked = results if name == "imported" else imported
        texts = [getattr(r, name) for r in asked]
        print(f"\n{name}: {texts.count('ok')} of {len(asked)}")
        reasons = Counter(t[:5] + kind_of(t) for t in texts if t != "ok")
        for reason, count in reasons.most_common():
            print(f"  {count:4} {reason[:150]}")
    for result in sorted(results, key=lambda r: -r.seconds)[:5]:
        print(f"slow: {result.seconds} s, {result.repository} {result.path}")
    largest = max((r.difference for r in imported if r.difference is not None), default=0.0)
    print(f"largest difference of accelerations: {largest:.1e}")
    return all(met for met in checks(results, imported))


def checks(results: list[Result], imported: list[Result]) -> list[bool]:
    out = []

    def check(words: str, is_met: bool) -> None:
        print(f"{'reached' if is_met else 'MISSED'}: {words}")
        out.append(is_met)

    def refused(text: str) -> bool:
        return text == "ok" or re.match(r"P\d{4} ", text) is not None

    share = len(imported) / max(len(results), 1)
    check(f"{len(results)} models, at least {LEAST_MODELS}", len(results) >= LEAST_MODELS)
    check(f"{share:.0%} imported, at least {LEAST_IMPORTED:.0%}", share >= LEAST_IMPORTED)
    check("every other model is refused by name", all(refused(r.imported) for r in results))
    steps = [r.analysed for r in imported] + [r.simulated for r in imported]
    named = all(refused(text) or text == "too slow" for text in steps)
    check("every imported model is analysed and simulated, or refused by name", named)
    texts = [r.accelerations for r in imported]
    missing = sum(text.startswith("not comparable") for text in texts) / max(len(texts), 1)
    most = f"at most {MOST_NOT_COMPARABLE:.0%}"
    check(f"accelerations of {missing:.0%} not comparable, {most}", missing <= MOST_NOT_COMPARABLE)
    close = all(text == "ok" or text.startswith("not comparable") for text in texts)
    check(f"accelerations are equal to within {BOUND}", close)
    equal = all(r.rank == "ok" or r.rank.startswith("not comparable") for r in imported)
    check("redundancy and mobility are equal", equal)
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder of fetched files, scenes and results")
    parser.add_argument("--fetch", action="store_true", help="download the files of the list")
    parser.add_argument("--mirror", type=Path, help="folder of clones OWNER/NAME.git to fetch from")
    parser.add_argument("--list", type=Path, default=HERE / "models.txt")
    parser.add_argument("--only", default="", help="models whose repository/path contains this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    release = ROOT / "target/release"
    parser.add_argument("--pfaff", default=str(release / "pfaff"))
    parser.add_argument("--program", default=str(release / "examples/imported_accelerations"))
    arguments = parser.parse_args()
    programs = Programs(arguments.pfaff, arguments.program)
    chosen = [e for e in entries(arguments.list) if arguments.only in e.name]
    if arguments.fetch:
        for entry in chosen:
            fetch(entry, arguments.folder, arguments.mirror)
    results = examine_all(chosen, arguments.folder, programs, arguments.jobs)
    with (arguments.folder / "results.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Result)])
        writer.writeheader()
        writer.writerows(asdict(result) for result in results)
    sys.exit(not report(results))


if __name__ == "__main__":
    main()
