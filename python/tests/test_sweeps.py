"""Sweeps: the table equals that of the command, for any engine and after any lost process."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PENDULUM, Command

import pfaff
from pfaff.cluster import SweepResult

SCENE = pfaff.Scene.from_string(PENDULUM.replace("t_end = 1.0", "t_end = 0.2"), "pendulum.toml")
VARY = {"body.bob.mass": "1:3:20", "scene.gravity[1]": [-9.81, -1.62]}

# The sweep takes long enough that a process can be ended during it.
LONG = pfaff.Scene.from_string(PENDULUM.replace("t_end = 1.0", "t_end = 2.0"), "pendulum.toml")
MANY = {"body.bob.mass": "1:3:3000"}


def _same(one: SweepResult, other: SweepResult) -> None:
    """Checks that all bits agree, except for the run times."""
    assert list(one.table) == list(other.table)
    for name, column in one.table.items():
        if name != "seconds":
            np.testing.assert_array_equal(column, other.table[name], err_msg=name)


@pytest.fixture(scope="module")
def whole() -> SweepResult:
    """Returns the sweep, performed in this process."""
    return SCENE.sweep(VARY)


@pytest.fixture(scope="module")
def many() -> SweepResult:
    """Returns the long sweep, performed in this process."""
    return LONG.sweep(MANY)


def test_the_table_is_that_of_the_command(
    whole: SweepResult, command: Command, tmp_path: Path
) -> None:
    path = tmp_path / "pendulum.toml"
    SCENE.write(path)
    out = tmp_path / "out"
    vary = ["--vary", "body.bob.mass=1:3:20", "--vary", "scene.gravity[1]=-9.81,-1.62"]
    summary = command.document("sweep", path, *vary, "--out", out)
    assert whole.document == summary
    with (out / "sweep.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert list(whole.table) == header
    assert len(rows) == 40
    for k, name in enumerate(header):
        column, texts = whole.table[name], [row[k] for row in rows]
        assert len(column) == 40
        if name == "seconds":
            continue
        if column.dtype == object:
            assert column.tolist() == texts
        else:
            np.testing.assert_array_equal(column, np.array(texts, dtype=float))
    # The command finds no unfinished run in a directory of Python, and vice versa.
    own = SCENE.sweep(VARY, tmp_path / "own")
    assert own.made == 40 and own.directory == str(tmp_path / "own")
    before = {file.name: file.read_bytes() for file in (tmp_path / "own" / "shards").iterdir()}
    command.run("sweep", path, *vary, "--out", tmp_path / "own")
    after = {file.name: file.read_bytes() for file in (tmp_path / "own" / "shards").iterdir()}
    assert after == before
    again = SCENE.sweep(VARY, out)
    assert again.made == 0
    _same(again, whole)


def test_what_is_varied_is_said_in_many_ways(whole: SweepResult) -> None:
    texts = ["body.bob.mass=1:3:20", "scene.gravity[1]=-9.81,-1.62"]
    _same(SCENE.sweep(texts), whole)
    arrays = {"body.bob.mass": np.array([1.0, 2.0]), "simulate.t_end": ["1e-1", 0.2]}
    made = SCENE.sweep(arrays)
    assert made.table["body.bob.mass"].tolist() == [1.0, 1.0, 2.0, 2.0]
    assert made.table["t"].tolist() == [0.1, 0.2, 0.1, 0.2]
    assert SCENE.sweep("body.bob.mass=1,2").document["done"] == 2


def test_failures_are_rows(tmp_path: Path) -> None:
    result = SCENE.sweep({"body.bob.mass": [-1.0, 1.0]}, tmp_path)
    (failure,) = result.failures
    assert (failure["run"], failure["status"]) == (1, "refused")
    assert "mass is -1" in failure["error"]
    assert np.isnan(result.table["steps"][0]) and np.isnan(result.table["bob.x"][0])
    assert "2 of 2 runs, 1 done" in repr(result)


def test_wrong_sweeps_are_refused(tmp_path: Path, command: Command) -> None:
    def refused(code: str, **arguments: Any) -> str:
        with pytest.raises(pfaff.InputError) as raised:
            pfaff.cluster.sweep(**{"scene": SCENE, "vary": VARY, **arguments})
        assert raised.value.code == code
        return str(raised.value)

    assert "there is no `bib`" in refused("P0501", vary={"body.bib.mass": [1, 2]})
    assert "is not KEY=FROM:TO:N" in refused("P0502", vary="body.bob.mass")
    assert "need a number or a text" in refused("P0001", vary={"body.bob.mass": [None]})
    assert "all 2 runs fail at the start" in refused("P0503", vary="body.bob.mass=-1,-2")
    assert "client is `int`" in refused("P0001", client=3, out=tmp_path)
    with ThreadPoolExecutor(1) as executor:
        assert "all workers see" in refused("P0001", client=executor)
    SCENE.sweep(VARY, tmp_path)
    assert "belongs to another sweep" in refused("P0505", vary="body.bob.mass=1,2", out=tmp_path)
    with pytest.raises(pfaff.SceneError) as raised:
        pfaff.Scene.from_string("scene = 3", "scene.toml").sweep(VARY)
    assert raised.value.place is not None


def test_progress_ends_a_sweep_and_it_is_resumed(many: SweepResult, tmp_path: Path) -> None:
    told: list[int] = []

    def end(finished: int, runs: int) -> bool:
        told.append(finished)
        assert runs == 3000
        return finished > 100

    part = LONG.sweep(MANY, tmp_path, on_progress=end)
    finished = part.document["finished"]
    assert 100 < finished < 3000 and told == sorted(told)
    assert part.missing and part.document["partial"]
    rest = LONG.sweep(MANY, tmp_path)
    assert rest.made == 3000 - finished
    _same(rest, many)
    known = part.table["seconds"]
    np.testing.assert_array_equal(rest.table["seconds"][part.table["run"] - 1], known)


def _script(body: str, *arguments: str | Path) -> subprocess.Popen[str]:
    """Starts a separate Python process in a separate process group."""
    words = [sys.executable, "-W", "error", "-c", textwrap.dedent(body), *map(str, arguments)]
    return subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )


def _rows(folder: Path) -> int:
    """Returns the number of finished runs in journals and shards."""
    runs: set[bytes] = set()
    for path in [*folder.glob("shards/*.journal"), *folder.glob("shards/*.rows")]:
        try:
            lines = path.read_bytes().split(b"\n")
        except FileNotFoundError:
            continue
        runs |= {line[17:].split(b",")[0] for line in lines if line[17:18].isdigit()}
    return len(runs)


def _until_rows(folder: Path, rows: int) -> None:
    begun = time.monotonic()
    while _rows(folder) < rows:
        assert time.monotonic() - begun < 120.0
        time.sleep(0.005)


def test_ctrl_c_is_heard(tmp_path: Path) -> None:
    body = """
        import sys, pfaff
        scene = pfaff.Scene.from_file(sys.argv[1])
        try:
            scene.sweep({"body.bob.mass": "1:3:3000"}, sys.argv[2])
        except KeyboardInterrupt:
            print("heard")
    """
    LONG.write(tmp_path / "scene.toml")
    child = _script(body, tmp_path / "scene.toml", tmp_path / "out")
    _until_rows(tmp_path / "out", 10)
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=60)
    assert (out, err) == ("heard\n", "")
    (journal,) = (tmp_path / "out" / "shards").glob("*.journal")
    assert any(line.endswith(" end") for line in journal.read_text().splitlines())


def _killed_during_a_run(scene: Path, out: Path) -> None:
    """Starts the sweep in a process that is killed during a run, as if memory were exhausted."""
    before = set(out.glob("shards/*.journal"))
    body = """
        import sys, pfaff
        scene = pfaff.Scene.from_file(sys.argv[1])
        scene.sweep({"simulate.t_end": [0.1, 10000.0, 0.2]}, sys.argv[2], threads=1)
    """
    child = _script(body, scene, out)
    begun = time.monotonic()
    while True:
        assert time.monotonic() - begun < 60.0 and child.poll() is None
        new = set(out.glob("shards/*.journal")) - before
        lines = [line for path in new for line in path.read_bytes().splitlines()]
        rows = [line for line in lines if line[17:19] == b"2,"]
        if not rows and any(line[17:] in (b"alone 2", b"begin 2", b"begin 1 2 3") for line in lines):
            break
        time.sleep(0.001)
    child.kill()
    child.communicate()


@pytest.mark.skipif(os.name != "posix", reason="kills a process")
def test_a_crashed_run_is_made_again_when_that_is_asked_for(tmp_path: Path) -> None:
    path, out = tmp_path / "scene.toml", tmp_path / "out"
    scene = pfaff.Scene.from_string(PENDULUM, "scene.toml")
    scene.write(path)
    vary = {"simulate.t_end": [0.1, 10000.0, 0.2]}
    # The run ends its process once among other runs, and twice alone.
    for _ in range(3):
        _killed_during_a_run(path, out)
    crashed = scene.sweep(vary, out)
    assert crashed.table["status"].tolist() == ["done", "crashed", "done"]
    (failure,) = crashed.failures
    assert failure["run"] == 2 and "the process ended twice" in failure["error"]
    # The run remains crashed until it is requested again; then no other run is performed.
    assert scene.sweep(vary, out).made == 0
    again = scene.sweep(vary, out, retry_crashed=True)
    assert (again.made, again.document["done"], again.document["crashed"]) == (1, 3, 0)
    whole = scene.sweep(vary)
    _same(again, whole)
    assert scene.sweep(vary, out, retry_crashed=True).made == 0


@pytest.mark.parametrize("kind", ["threads", "processes"])
def test_executors(kind: str, whole: SweepResult, tmp_path: Path) -> None:
    executor: Executor
    if kind == "threads":
        executor = ThreadPoolExecutor(2)
    else:
        executor = ProcessPoolExecutor(2, mp_context=get_context("spawn"))
    with executor:
        result = pfaff.cluster.sweep(SCENE, VARY, executor, out=tmp_path, shards=7)
    assert result.made == 40
    _same(result, whole)
    assert len(list(tmp_path.glob("shards/*.rows"))) == 7
    assert json.loads((tmp_path / "summary.json").read_text())["finished"] == 40


def test_the_number_of_shards_is_chosen(tmp_path: Path) -> None:
    with ThreadPoolExecutor(3) as executor:
        pfaff.cluster.sweep(SCENE, VARY, executor, out=tmp_path)
        # If runs are short, there is one shard for each worker.
        assert len(list(tmp_path.glob("shards/*.rows"))) == 3
        # The number of shards of an existing directory is kept.
        (tmp_path / "shards" / "01-13.rows").unlink()
        result = pfaff.cluster.sweep(SCENE, VARY, executor, out=tmp_path)
    assert result.made == 13
    assert len(list(tmp_path.glob("shards/*.rows"))) == 3


class KilledWorker(Exception):
    """The exception that Dask raises if a task has lost its workers."""


class Lossy(ThreadPoolExecutor):
    """An executor that loses the worker of the trial runs."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        if fn is pfaff.cluster._tried:
            lost: Future[Any] = Future()
            lost.set_exception(KilledWorker())
            return lost
        return super().submit(fn, *args, **kwargs)


def test_a_worker_that_is_lost_while_it_tries_runs_ends_nothing(
    whole: SweepResult, tmp_path: Path
) -> None:
    with Lossy(3) as executor:
        result = pfaff.cluster.sweep(SCENE, VARY, executor, out=tmp_path)
    assert result.made == 40
    _same(result, whole)
    # All runs together are assumed to take the time of one shard: four shards for each worker.
    assert len(list(tmp_path.glob("shards/*.rows"))) == 12


def test_joblib(whole: SweepResult, tmp_path: Path) -> None:
    joblib = pytest.importorskip("joblib")
    parallel = joblib.Parallel(n_jobs=2)
    result = pfaff.cluster.sweep(SCENE, VARY, parallel, out=tmp_path, shards=5)
    assert result.made == 40
    _same(result, whole)


RAY = """
    import sys, ray, pfaff
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    scene = pfaff.Scene.from_file(sys.argv[1])
    vary = {"body.bob.mass": "1:3:20", "scene.gravity[1]": [-9.81, -1.62]}
    result = pfaff.cluster.sweep(scene, vary, ray, out=sys.argv[2], shards=5)
    print(result.made, len(result.missing))
    ray.shutdown()
"""


def test_ray(whole: SweepResult, tmp_path: Path) -> None:
    pytest.importorskip("ray")
    SCENE.write(tmp_path / "scene.toml")
    words = [sys.executable, "-c", textwrap.dedent(RAY)]
    words += [str(tmp_path / "scene.toml"), str(tmp_path / "out")]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=300)
    assert done.stdout.split() == ["40", "0"], done.stderr
    _same(SCENE.sweep(VARY, tmp_path / "out"), whole)


# A cluster of this machine with a client that returns the process ids of its workers.
DASK = """
    import sys
    import pfaff
    from dask.distributed import Client, LocalCluster
    if __name__ == "__main__":
        scene = pfaff.Scene.from_file(sys.argv[1])
        with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                print(*client.run(__import__("os").getpid).values(), flush=True)
                retired = []

                def at_progress(finished, of):
                    if sys.argv[3] == "retire" and not retired and 0 < finished < of:
                        retired.append(list(client.nthreads())[0])
                        client.retire_workers(retired)

                result = pfaff.cluster.sweep(
                    scene,
                    {"body.bob.mass": "1:3:3000"},
                    client,
                    out=sys.argv[2],
                    shards=20,
                    on_progress=at_progress,
                )
                print(result.made, result.document["finished"], result.document["crashed"], flush=True)
"""


def _dask(tmp_path: Path, out: Path, how: str = "") -> tuple[subprocess.Popen[str], list[int]]:
    pytest.importorskip("distributed")
    LONG.write(tmp_path / "scene.toml")
    script = tmp_path / "script.py"
    script.write_text(textwrap.dedent(DASK))
    child = subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "scene.toml"), str(out), how],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    assert child.stdout is not None
    workers = [int(pid) for pid in child.stdout.readline().split()]
    assert len(workers) == 2
    return child, workers


def test_dask_loses_a_worker(many: SweepResult, tmp_path: Path) -> None:
    out = tmp_path / "out"
    child, workers = _dask(tmp_path, out)
    _until_rows(out, 700)
    os.kill(workers[0], signal.SIGKILL)
    text, _ = child.communicate(timeout=300)
    made, finished, crashed = (int(word) for word in text.split())
    assert (finished, crashed) == (3000, 0)
    # Runs of its shards that the lost worker had finished were not repeated.
    assert 3000 - 300 <= made <= 3000
    result = LONG.sweep(MANY, out)
    assert (result.made, result.document["repeated"]) == (0, 0)
    _same(result, many)


def test_a_worker_of_dask_retires_and_others_go_on(many: SweepResult, tmp_path: Path) -> None:
    out = tmp_path / "out"
    child, _ = _dask(tmp_path, out, "retire")
    text, _ = child.communicate(timeout=300)
    made, finished, crashed = (int(word) for word in text.split())
    # The shard that it ended properly is continued, and none of its runs counts as the cause.
    assert (finished, crashed) == (3000, 0)
    assert 3000 - 150 <= made <= 3000
    result = LONG.sweep(MANY, out)
    assert (result.made, result.document["repeated"]) == (0, 0)
    _same(result, many)


def test_dask_loses_its_client_and_is_resumed(many: SweepResult, tmp_path: Path) -> None:
    out = tmp_path / "out"
    child, _ = _dask(tmp_path, out)
    _until_rows(out, 1000)
    # All processes end: client, scheduler, workers.
    os.killpg(child.pid, signal.SIGKILL)
    child.communicate()
    time.sleep(0.5)
    before = _rows(out)
    assert 1000 <= before < 3000
    child, _ = _dask(tmp_path, out)
    text, _ = child.communicate(timeout=300)
    made, finished, crashed = (int(word) for word in text.split())
    # No finished run was repeated, neither from shards nor from journals.
    assert (finished, crashed) == (3000, 0)
    assert made == 3000 - before
    result = LONG.sweep(MANY, out)
    assert (result.made, result.document["repeated"]) == (0, 0)
    _same(result, many)


def test_two_hundred_shards_are_resumed_after_one_hundred(tmp_path: Path) -> None:
    vary = {"body.bob.mass": "1:3:400"}
    seen: list[int] = []

    def half(finished: int, _: int) -> bool:
        seen.append(finished)
        return len(seen) > 100

    with ThreadPoolExecutor(1) as executor:
        part = pfaff.cluster.sweep(
            SCENE, vary, executor, out=tmp_path, shards=200, on_progress=half
        )
    first = len(list(tmp_path.glob("shards/*.rows")))
    assert 100 <= first < 200 and part.document["partial"]
    before = {path: path.read_bytes() for path in tmp_path.glob("shards/*.rows")}
    with ThreadPoolExecutor(1) as executor:
        rest = pfaff.cluster.sweep(SCENE, vary, executor, out=tmp_path)
    # Each shard has two runs; the times of all finished runs are unchanged.
    assert rest.made == 2 * (200 - first)
    assert len(list(tmp_path.glob("shards/*.rows"))) == 200
    assert all(path.read_bytes() == content for path, content in before.items())
    _same(rest, SCENE.sweep(vary))
