"""This report compares sweeps on Dask with two processes, each with a shard, and measures the loss after a kill.

After `python python/build.py`: `python/target/venv/bin/python docs/reports/clusters/measure.py`. The
two processes are those of Python, or with `--command target/release/pfaff` those of the command.
Writes `measured.json` beside itself.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
PENDULUM = """
scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "bob", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] }]
joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
simulate = { t_end = 0.5 }
"""
CASES = {
    "pendulum": (PENDULUM, "body.bob.mass=1:3:50000"),
    "robot": (
        (ROOT / "crates" / "robot-trolley" / "robot-trolley.toml").read_text(encoding="utf-8"),
        "body.platform.mass=10:40:2000",
    ),
}


def spent(who: int) -> float:
    """Processor time (s)."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


SHARD = """
import sys
from pfaff.cluster import Shard, make_shard
scene, vary, out, k = sys.argv[1:]
text = open(scene, encoding="utf-8").read()
make_shard(Shard(text, scene, (vary,), False, out, int(k), 2, 1))
"""


def by_processes(command: Path | None, scene: Path, vary: str, out: Path) -> dict[str, float]:
    """Two processes with a shard each; the one that ends last writes the tables."""
    before, begun = spent(resource.RUSAGE_CHILDREN), time.monotonic()
    if command is None:
        words = [[sys.executable, "-c", SHARD, scene, vary, out, k] for k in (1, 2)]
    else:
        options = ["--vary", vary, "--out", out, "--threads", "1"]
        words = [[command, "sweep", scene, *options, "--shard", f"{k}/2"] for k in (1, 2)]
    children = [
        subprocess.Popen([str(word) for word in some], stdout=subprocess.DEVNULL) for some in words
    ]
    for child in children:
        assert child.wait() == 0
    wall = time.monotonic() - begun
    return {"wall": wall, "processor": spent(resource.RUSAGE_CHILDREN) - before}


def workers_spent(client: Any) -> float:
    """Processor time of the workers (s)."""

    def own() -> float:
        import resource as here

        usage = here.getrusage(here.RUSAGE_SELF)
        return usage.ru_utime + usage.ru_stime

    return float(sum(client.run(own).values()))


def by_dask(scene: Path, vary: str, out: Path) -> dict[str, float]:
    """The same with Dask, with the table as arrays at the end; the cluster is there before."""
    import pfaff
    from dask.distributed import Client, LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, Client(cluster) as client:
        client.run(__import__, "pfaff")
        workers, own = workers_spent(client), spent(resource.RUSAGE_SELF)
        begun = time.monotonic()
        result = pfaff.cluster.sweep(pfaff.Scene.from_file(scene), vary, client, out=out)
        wall = time.monotonic() - begun
        assert result.missing == [] and result.document["done"] == result.document["runs"]
        workers, own = workers_spent(client) - workers, spent(resource.RUSAGE_SELF) - own
        shards = len(list(out.glob("shards/*.rows")))
    return {"wall": wall, "processor": workers + own, "of the client": own, "shards": shards}


def table(out: Path) -> list[list[str]]:
    """The table without the time of runs."""
    rows = [line.split(",") for line in (out / "sweep.csv").read_text(encoding="utf-8").splitlines()]
    seconds = rows[0].index("seconds")
    for row in rows:
        del row[seconds]
    return rows


CLIENT = """
import sys
import pfaff
from dask.distributed import Client, LocalCluster
if __name__ == "__main__":
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, Client(cluster) as client:
        print(*client.run(__import__("os").getpid).values(), flush=True)
        result = pfaff.cluster.sweep(
            pfaff.Scene.from_file(sys.argv[1]), sys.argv[2], client, out=sys.argv[3], shards=40
        )
        print(result.made, flush=True)
"""


def finished(out: Path) -> int:
    """Number of finished runs."""
    runs: set[bytes] = set()
    for path in [*out.glob("shards/*.journal"), *out.glob("shards/*.rows")]:
        try:
            lines = path.read_bytes().split(b"\n")
        except FileNotFoundError:
            continue
        runs |= {line[17:].split(b",")[0] for line in lines if line[17:18].isdigit()}
    return len(runs)


def killed(scene: Path, vary: str, out: Path, runs: int) -> dict[str, Any]:
    """A worker is killed at a third, everything at two thirds; then it is resumed."""
    script = out.with_suffix(".py")
    script.write_text(CLIENT)

    def begun() -> tuple[subprocess.Popen[str], list[int]]:
        words = [sys.executable, str(script), str(scene), vary, str(out)]
        child = subprocess.Popen(
            words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True
        )
        assert child.stdout is not None
        return child, [int(pid) for pid in child.stdout.readline().split()]

    def until(count: int) -> int:
        while finished(out) < count:
            time.sleep(0.05)
        return finished(out)

    child, workers = begun()
    at_worker = until(runs // 3)
    os.kill(workers[0], signal.SIGKILL)
    until(2 * runs // 3)
    os.killpg(child.pid, signal.SIGKILL)
    child.wait()
    time.sleep(0.5)
    at_client = finished(out)
    child, _ = begun()
    text, _ = child.communicate()
    return {"worker killed at": at_worker, "client killed at": at_client, "made after": int(text)}


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", type=Path)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--cases", default=",".join(CASES))
    parser.add_argument("--robots", type=int, default=2000, help="runs of the robot")
    parser.add_argument("--no-profiler", action="store_true", help="without that of Dask")
    arguments = parser.parse_args()
    if arguments.no_profiler:
        os.environ["DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED"] = "false"
    text, _ = CASES["robot"]
    CASES["robot"] = (text, f"body.platform.mass=10:40:{arguments.robots}")
    import pfaff

    command = arguments.command and arguments.command.resolve()
    measured: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for case in arguments.cases.split(","):
            text, vary = CASES[case]
            scene = folder / f"{case}.toml"
            scene.write_text(text)
            turns = []
            for turn in range(arguments.turns):
                outs = [folder / f"{case}-{kind}-{turn}" for kind in ("processes", "dask")]
                turns.append({
                    "processes": by_processes(command, scene, vary, outs[0]),
                    "dask": by_dask(scene, vary, outs[1]),
                })
                assert table(outs[0]) == table(outs[1])
                print(case, json.dumps(turns[-1]), flush=True)
            least = {
                what: min(t["dask"][what] for t in turns) / min(t["processes"][what] for t in turns)
                for what in ("wall", "processor")
            }
            measured[case] = {"vary": vary, "turns": turns, "ratio of the least": least}
            print(case, least, flush=True)
            if case == "pendulum":
                out = folder / f"{case}-killed"
                measured["killed"] = killed(scene, vary, out, 50000)
                whole = folder / f"{case}-whole"
                # One process, one thread.
                pfaff.Scene.from_file(scene).sweep(vary, whole, threads=1)
                measured["killed"]["equal"] = table(out) == table(whole)
                print(measured["killed"], flush=True)
    (HERE / "measured.json").write_text(json.dumps(measured, indent=2) + "\n")


if __name__ == "__main__":
    main()
