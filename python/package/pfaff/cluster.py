"""Sweeps: many runs of one scene with varied values, here or on the machines of a cluster.

>>> import pfaff.cluster
>>> from dask.distributed import Client  # doctest: +SKIP
>>> result = pfaff.cluster.sweep(  # doctest: +SKIP
...     scene, {"body.cart.mass": "5:20:1000"}, Client("scheduler:8786"), out="masses"
... )

The unit of work is a shard: consecutive runs that take some tens of seconds. A finished shard is a
file in the directory, which must be visible to all workers. A worker that receives a finished shard
does nothing; a worker that receives a partly finished shard continues it. Therefore the engine may
repeat lost work.
"""

from __future__ import annotations

import functools
import json
import math
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _arguments as arguments
from . import _pfaff
from . import _toml as toml
from ._errors import wrong, wrong_type

if TYPE_CHECKING:
    from ._scene import Scene

__all__ = ["Done", "Shard", "SweepResult", "make_shard", "sweep"]

Vary = Mapping[str, Any] | str | Sequence[str]
"""Keys with their values, or texts in the syntax of ``pfaff sweep --vary``."""

SHARD_SECONDS = 20.0
"""Target time (s) of a shard. Small values cause many files; large values cause idle workers."""

SHARD_SECONDS_LEAST = 2.0
"""Smallest target time of a shard if there are few shards."""

SHARDS_PER_WORKER = 4
"""Target number of shards for each worker, so that all workers end at similar times."""

PROBE_SECONDS = 0.5
"""Total time of trial runs, which measure the time of one run."""

PROBES = 16
"""Largest number of trial runs."""


class Shard(NamedTuple):
    """One of n parts of a sweep, with all data to perform it on any machine."""

    text: str
    """Text of the scene."""
    name: str
    """Name of the text in messages."""
    vary: tuple[str, ...]
    """The varied keys with their values."""
    keep_rows: bool
    """Whether each run keeps its trajectory."""
    out: str
    """The directory for the results."""
    k: int
    """Index of the part (1-based)."""
    n: int
    """Number of parts."""
    threads: int
    """Number of threads for the shard; 0 means all cores."""


class Done(NamedTuple):
    """The result of performing a shard."""

    k: int
    """Index of the part."""
    made: int
    """Number of runs that were performed; the other runs were finished before."""
    tables: bool
    """Whether this was the last shard, which writes the tables."""
    summary: dict[str, Any]
    """The summary of the runs of the shard."""


def make_shard(shard: Shard) -> Done:
    """Performs the unfinished runs of a shard. All engines perform this task."""
    done = _made(shard, None, _stop_of_worker())
    if done.summary["partial"]:
        raise RuntimeError(f"the worker ends, and shard {shard.k} of {shard.n} is not finished")
    return done


def _made(
    shard: Shard, on_runs: Callable[[int, int], object] | None, stop: Callable[[], bool] | None
) -> Done:
    of = _sweep_of(shard.name, shard.text, shard.vary, shard.keep_rows)
    summary, made, tables = of.make(shard.out, shard.k, shard.n, shard.threads, on_runs, stop)
    return Done(shard.k, made, tables, json.loads(summary))


def _read(name: str, text: str, vary: tuple[str, ...], keep_rows: bool) -> _pfaff.Sweep:
    """Returns a sweep that stores results for all of its runs."""
    return _pfaff.Sweep(name, text, list(vary), keep_rows)


_sweep_of = functools.lru_cache(maxsize=2)(_read)
"""Returns the same sweep for all shards of a worker."""


def _tried(shard: Shard) -> float:
    """Estimates the time of one run (s) from a few trial runs. Engines perform this task."""
    of = _sweep_of(shard.name, shard.text, shard.vary, shard.keep_rows)
    runs = of.runs
    most = min(PROBES, runs)
    tried = sorted({1 + k * (runs - 1) // max(1, most - 1) for k in range(most)})
    # The order is changed, so that the trial does not consist of neighbouring runs only.
    tried = tried[::3] + tried[1::3] + tried[2::3]
    spent: list[float] = []
    for run in tried:
        spent.append(of.seconds(run))
        if sum(spent) > PROBE_SECONDS:
            break
    # The first run takes longer because of the initialisation.
    usual = spent[1:] or spent
    return sum(usual) / len(usual)


def _stop_of_worker() -> Callable[[], bool] | None:
    """Whether the worker of Dask that executes this call is about to end.

    If the shard then ends properly, no run of the shard counts as the cause of the end.
    """
    distributed = sys.modules.get("distributed")
    if distributed is None:
        return None
    try:
        worker = distributed.get_worker()
    except ValueError:
        return None
    return lambda: "clos" in str(worker.status)


class SweepResult:
    """The finished runs of a sweep."""

    def __init__(
        self, directory: str | None, made: int, summary: str, columns: list[tuple[str, Any]]
    ) -> None:
        self.directory = directory
        """The directory; ``None`` if the directory was temporary."""
        self.made = made
        """Number of runs that this call performed; the other runs were finished before."""
        self.document: dict[str, Any] = json.loads(summary)
        """The summary, as in ``summary.json``."""
        self.table: dict[str, NDArray[Any]] = {name: _column(values) for name, values in columns}
        """The columns of ``sweep.csv``, a value for each finished run, in the order of the grid."""

    @property
    def failures(self) -> list[dict[str, Any]]:
        """Runs without a complete result, with ``run``, ``status`` and ``error``."""
        columns = [self.table[name] for name in ("run", "status", "error")]
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return [
            {"run": run, "status": status, "error": error}
            for run, status, error in rows
            if status != "done"
        ]

    @property
    def missing(self) -> list[tuple[int, int]]:
        """First and last runs of the gaps between finished runs."""
        return [(first, last) for first, last in self.document["missing"]]

    def to_pandas(self) -> Any:
        """Returns the table as a ``pandas.DataFrame`` with the numbers of the runs as its index."""
        import pandas

        return pandas.DataFrame(self.table).set_index("run")

    def to_polars(self) -> Any:
        """Returns the table as a ``polars.DataFrame``."""
        import polars

        columns = {
            name: column.tolist() if column.dtype == object else column
            for name, column in self.table.items()
        }
        return polars.DataFrame(columns)

    def __repr__(self) -> str:
        d = self.document
        runs = f"{d['finished']} of {d['runs']} runs, {d['done']} done"
        return f"<pfaff.SweepResult {d['scene']!r}: {runs}>"


def _column(values: Any) -> NDArray[Any]:
    if isinstance(values, np.ndarray):
        return values
    texts = np.empty(len(values), dtype=object)
    texts[:] = values
    return texts


def sweep(
    scene: Scene,
    vary: Vary,
    client: Any = None,
    *,
    out: str | os.PathLike[str] | None = None,
    shards: int | None = None,
    threads: int | None = None,
    retries: int = 3,
    keep_rows: bool = False,
    retry_crashed: bool = False,
    on_progress: Callable[[int, int], object] | None = None,
    progress: bool | None = None,
) -> SweepResult:
    """Runs a scene with every combination of values.

    ``vary`` contains for each key a list of values or a text such as ``"5:20:1000"``. Values are
    numbers, or texts with units. Alternatively, ``vary`` is a text, or a list of texts, in the
    syntax of ``pfaff sweep --vary``.

    ``client`` performs the shards. It is a client of Dask, the module ``ray`` or its name, a
    ``joblib.Parallel``, or an executor of ``concurrent.futures``. With ``None``, this process
    performs the shards. ``out`` is a directory that all workers can access; without a client, it is
    optional. The same call in the same directory resumes a sweep. If the sweep is finished, the
    call only reads the results.

    ``shards`` is the number of parts. The default is the number in an existing directory. For a new
    directory, the number follows from a few trial runs of a worker, so that each part takes some
    tens of seconds. ``threads`` is the number of threads for one shard. The default is one, or all
    cores without a client. Both the engine and this function repeat lost work up to ``retries``
    times.

    If a run has ended its process twice, its row is ``crashed``, and this row is final. With
    ``retry_crashed`` such runs are repeated as new runs. This is useful, for instance, after a
    worker was killed because its machine had too little memory. At the beginning of such a call, no
    other process may work in the directory.

    ``on_progress`` receives the numbers of finished runs and of all runs; the sweep ends if this
    function returns ``True``. ``progress`` shows a progress line. The default is to show the line
    if standard error is a terminal.
    """
    texts = tuple(_texts(vary))
    keep_rows = arguments.flag("keep_rows", keep_rows)
    retries = arguments.count("retries", retries)
    shards = arguments.maybe(arguments.count, "shards", shards)
    threads = arguments.maybe(arguments.count, "threads", threads)
    if on_progress is not None:
        arguments.function("on_progress", on_progress, "two numbers of runs")
    of = _sweep_of(scene.file, scene.text, texts, keep_rows)
    engine = _engine(client)
    if shards is not None and shards < 1:
        raise wrong(f"shards is {shards}, need a number ≥ 1")
    if threads is None:
        threads = 0 if engine is None else 1
    told = _Told(of.runs, on_progress, sys.stderr.isatty() if progress is None else progress)

    def made_in(directory: str) -> int:
        part = Shard(scene.text, scene.file, texts, keep_rows, directory, 1, 1, threads)
        try:
            if engine is None:
                return _make_here(part, shards or 1, told)
            return _make_by(engine, of, part, shards, retries, told)
        finally:
            told.end()

    if out is not None:
        directory = os.path.abspath(arguments.path("out", out))
        if arguments.flag("retry_crashed", retry_crashed):
            _pfaff.forget_crashed(directory)
        made = made_in(directory)
        return SweepResult(directory, made, *_pfaff.sweep_columns(directory))
    if engine is not None:
        raise wrong("out is None, need a directory that all workers see")
    with tempfile.TemporaryDirectory() as folder:
        made = made_in(folder)
        return SweepResult(None, made, *_pfaff.sweep_columns(folder))


def _make_here(part: Shard, n: int, told: _Told) -> int:
    """Performs the unfinished runs in this process; returns the number of performed runs."""
    made = before = 0
    for k in range(1, n + 1):
        done = _made(part._replace(k=k, n=n), lambda count, _: told.now(before + count), None)
        made += done.made
        before += done.summary["finished"]
        if told.now(before):
            break
    return made


def _make_by(
    engine: _Engine, of: _pfaff.Sweep, part: Shard, shards: int | None, retries: int, told: _Told
) -> int:
    """Lets an engine perform the unfinished runs; returns the number of performed runs."""
    n = shards or of.shards(part.out) or _number(engine, part, of.runs)
    left = of.unfinished(part.out, n)
    finished = of.runs - sum(_size(of.runs, k, n) for k in left)
    told.now(finished)
    made = 0
    has_tables = False
    for done in engine.run(make_shard, [part._replace(k=k, n=n) for k in left], retries):
        made += done.made
        has_tables |= done.tables
        finished += done.summary["finished"]
        if told.now(finished):
            return made
    if not has_tables:
        # All shards were finished before, or the last worker could not see the files of all shards.
        _pfaff.merge([part.out], part.out)
    return made


def _size(runs: int, k: int, n: int) -> int:
    """Returns the number of runs of the k-th of n shards."""
    return k * runs // n - (k - 1) * runs // n


def _number(engine: _Engine, part: Shard, runs: int) -> int:
    """Returns the number of shards, from a few trial runs of a worker."""
    workers = engine.workers(part.threads)
    try:
        (seconds,) = engine.run(_tried, [part], 0)
    except Exception as error:
        if not _is_lost(error):
            raise
        # A run ends its worker. The shards identify this run and continue without the run.
        total = SHARD_SECONDS
    else:
        total = runs * seconds
    few = min(SHARDS_PER_WORKER * workers, math.ceil(total / SHARD_SECONDS_LEAST))
    n = max(1, few, math.ceil(total / SHARD_SECONDS))
    # With this number all workers are busy to the end.
    n = math.ceil(n / workers) * workers
    return max(1, min(n, runs))


def _texts(vary: Vary) -> list[str]:
    """Returns the varied values in the syntax of the command."""
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        return arguments.texts("vary", vary)
    return [f"{key}={_values(key, values)}" for key, values in vary.items()]


def _values(key: str, values: Any) -> str:
    if isinstance(values, str):
        return values
    if hasattr(values, "tolist"):
        values = values.tolist()
    if not isinstance(values, Iterable):
        values = [values]
    texts = []
    for value in values:
        try:
            texts.append(value if isinstance(value, str) else toml.number(float(value)))
        except (TypeError, ValueError):
            raise wrong_type(f"a value of `{key}`", value, "a number or a text") from None
    return ",".join(texts)


class _Told:
    """Progress: a callback, and a progress line."""

    def __init__(
        self, runs: int, callback: Callable[[int, int], object] | None, shown: bool
    ) -> None:
        self.runs = runs
        self.finished = 0
        self._callback = callback
        self._shown = shown
        self._begun = time.monotonic()
        self._width = 0

    def now(self, finished: int) -> bool:
        """Reports the number of finished runs; returns true if the sweep has to end."""
        self.finished = finished
        if self._shown:
            seconds = time.monotonic() - self._begun
            line = f"{finished} of {self.runs} runs, {seconds:.0f} s"
            self._width = max(self._width, len(line))
            print(f"\r{line:<{self._width}}", end="", file=sys.stderr, flush=True)
        return self._callback is not None and bool(self._callback(finished, self.runs))

    def end(self) -> None:
        """Ends the progress line."""
        if self._shown and self._width:
            print(file=sys.stderr)


T = TypeVar("T")
Task = Callable[[Shard], T]
"""The work on a shard."""


class _Engine:
    """An engine that performs shards."""

    def __init__(self, client: Any) -> None:
        self.client = client

    def workers(self, threads: int) -> int:
        """Returns the number of shards that are performed at the same time."""
        raise NotImplementedError

    def run(self, task: Task[T], shards: list[Shard], retries: int) -> Iterator[T]:
        """Performs a task with each of some shards, in any order."""
        raise NotImplementedError


def _is_lost(error: BaseException) -> bool:
    """Whether an error means that workers were lost, and not that the task is invalid."""
    return type(error).__name__ in ("KilledWorker", "WorkerCrashedError", "TerminatedWorkerError")


class _Dask(_Engine):
    def workers(self, threads: int) -> int:
        return max(1, int(sum(self.client.nthreads().values())))

    def run(self, task: Task[T], shards: list[Shard], retries: int) -> Iterator[T]:
        as_completed: Any = import_module("distributed").as_completed
        again = dict.fromkeys(shards, retries)
        names: dict[Any, Shard] = {}

        def submitted(some: list[Shard]) -> list[Any]:
            key = f"pfaff-{task.__name__.strip('_')}"
            futures = self.client.map(task, some, key=key, pure=False, retries=retries)
            names.update(zip((future.key for future in futures), some, strict=True))
            return list(futures)

        futures = submitted(shards)
        waiting = as_completed(futures)
        try:
            for future in waiting:
                error = future.exception() if future.status == "error" else None
                shard = names[future.key]
                if error is not None and _is_lost(error) and again[shard] > 0:
                    # Each loss gives more information about the run that causes it.
                    again[shard] -= 1
                    more = submitted([shard])
                    futures += more
                    waiting.update(more)
                else:
                    yield future.result()
        finally:
            self.client.cancel(futures)


class _Ray(_Engine):
    def workers(self, threads: int) -> int:
        cores = int(self.client.cluster_resources().get("CPU", 1))
        return max(1, cores // max(1, threads))

    def run(self, task: Task[T], shards: list[Shard], retries: int) -> Iterator[T]:
        ray = self.client
        threads = max((shard.threads for shard in shards), default=1)
        made = ray.remote(num_cpus=max(1, threads), max_retries=retries)(task)
        again = dict.fromkeys(shards, retries)
        waiting = {made.remote(shard): shard for shard in shards}
        try:
            while waiting:
                (reference, *_), _ = ray.wait(list(waiting), num_returns=1)
                shard = waiting.pop(reference)
                try:
                    yield ray.get(reference)
                except Exception as error:
                    if not _is_lost(error) or again[shard] <= 0:
                        raise
                    again[shard] -= 1
                    waiting[made.remote(shard)] = shard
        finally:
            for reference in waiting:
                ray.cancel(reference)


class _Joblib(_Engine):
    def workers(self, threads: int) -> int:
        joblib: Any = import_module("joblib")
        return max(1, int(joblib.effective_n_jobs(self.client.n_jobs)))

    def run(self, task: Task[T], shards: list[Shard], retries: int) -> Iterator[T]:
        joblib: Any = import_module("joblib")
        for left in range(retries, -1, -1):
            try:
                yield from self.client(joblib.delayed(task)(shard) for shard in shards)
                return
            except Exception as error:
                # A repeated call skips finished shards.
                if not _is_lost(error) or left == 0:
                    raise


class _Executor(_Engine):
    def workers(self, threads: int) -> int:
        most: int | None = getattr(self.client, "_max_workers", None)
        return max(1, most or os.cpu_count() or 1)

    def run(self, task: Task[T], shards: list[Shard], retries: int) -> Iterator[T]:
        from concurrent.futures import as_completed

        futures = [self.client.submit(task, shard) for shard in shards]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            for future in futures:
                future.cancel()


def _engine(client: Any) -> _Engine | None:
    """Selects the engine by the methods of the client, without imports of missing packages."""
    if client is None:
        return None
    if client == "ray":
        return _Ray(import_module("ray"))
    if isinstance(client, ModuleType) and client.__name__ == "ray":
        return _Ray(client)
    if hasattr(client, "map") and hasattr(client, "nthreads"):
        return _Dask(client)
    if type(client).__module__.split(".")[0] == "joblib":
        return _Joblib(client)
    if hasattr(client, "submit") and hasattr(client, "shutdown"):
        return _Executor(client)
    needed = "a client of Dask, the module `ray`, a joblib.Parallel or an executor"
    raise wrong_type("client", client, needed)
