"""Tests insufficient memory, Ctrl-C during any computation, and forked processes."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from conftest import PENDULUM, Command

import pfaff

POSIX = pytest.mark.skipif(os.name != "posix", reason="a limit or a signal of POSIX")
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="reads what Linux states of its memory")


def chain(bodies: int) -> str:
    """Returns a chain of bodies in the plane as a text."""
    lines = ["scene = { name = 'chain', space = 'plane', gravity = [0.0, -9.81] }"]
    for k in range(bodies):
        at = f"position = [{k + 0.5}, 0.0]"
        lines.append(f"[[body]]\nname = 'b{k}'\nmass = 1.0\ninertia = 0.1\n{at}")
    for k in range(bodies):
        pair = f"['{f'b{k - 1}' if k else 'ground'}', 'b{k}']"
        lines.append(f"[[joint]]\nname = 'j{k}'\ntype = 'revolute'\nbodies = {pair}\nat = [{k}.0, 0.0]")
    return "\n".join(lines) + "\n"


MEMORY = """
    import resource, sys
    resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[1]) << 20,) * 2)
    import pfaff
    scene = pfaff.Scene.from_string(sys.stdin.read())
    try:
        {call}
        print("made")
    except pfaff.ComputationError as error:
        print(error.code, error)
"""


@LINUX
@pytest.mark.parametrize(
    ("text", "call", "words"),
    [
        (chain(6000), "scene.matrices()", "this set of dense matrices takes about 4.3 GB"),
        (PENDULUM, "scene.simulate(output_step=1e-7)", "this run with its rows takes about 1.3 GB"),
        (chain(200_000), "scene.check()", "reading this scene takes about"),
    ],
    ids=["matrices", "rows", "reading"],
)
def test_what_does_not_fit_is_refused_before_it_is_taken(text: str, call: str, words: str) -> None:
    """The process has an address space of 1 GB: an allocation that fails would abort it."""
    code = textwrap.dedent(MEMORY).format(call=call)
    child = [sys.executable, "-W", "error", "-c", code, "1024"]
    done = subprocess.run(child, input=text, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("P0007 ") and words in done.stdout, done.stdout


CALLS: dict[str, Callable[[pfaff.Scene, Any], object]] = {
    "check": lambda scene, limit: scene.check(max_memory=limit),
    "analyze": lambda scene, limit: scene.analyze(max_memory=limit),
    "simulate": lambda scene, limit: scene.simulate(max_memory=limit),
    "simulate_into": lambda scene, limit: scene.simulate_into("nowhere", max_memory=limit),
    "tolerance": lambda scene, limit: scene.tolerance(2, tolerance=1e-3, max_memory=limit),
    "matrices": lambda scene, limit: scene.matrices(max_memory=limit),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_a_limit_of_memory(call: Callable[[pfaff.Scene, Any], object]) -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    for limit in ("1MB", 1_000_000):
        with pytest.raises(pfaff.ComputationError, match="max_memory allows 1 MB") as raised:
            call(scene, limit)
        assert raised.value.code == "P0007"
    with pytest.raises(pfaff.InputError, match="`4` is not a size; write a number with B, kB, MB"):
        call(scene, "4")
    with pytest.raises(TypeError, match="max_memory is `float`, need a number of bytes, or a text"):
        call(scene, 1.5)
    assert not Path("nowhere").exists()


def test_a_limit_of_memory_is_that_of_the_command(command: Command, tmp_path: Path) -> None:
    """This is also true if the scene has already been assembled."""
    path = tmp_path / "chain.toml"
    path.write_text(chain(300), encoding="utf-8")
    scene = pfaff.Scene.from_file(path)
    scene.check()
    with pytest.raises(pfaff.ComputationError) as raised:
        scene.check(max_memory="12MB")
    told = command.document("check", path, "--max-memory", "12MB")["error"]
    assert raised.value.document["error"] == told.replace("--max-memory", "max_memory")


LONG = """
    import os, signal, sys, threading, time
    import pfaff
    kind, text = sys.argv[1], sys.stdin.read()
    analysis = pfaff.Scene.from_string(text).analyze() if kind == "document" else None
    sent = []
    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.3, send).start()
    try:
        while True:
            if kind == "import":
                pfaff.Scene.from_mjcf(text=text)
            elif kind == "document":
                analysis._document = None
                analysis.document
            elif kind == "matrices":
                try:
                    pfaff.Scene.from_string(text).matrices(max_memory="1GB")
                except pfaff.ComputationError:
                    pass
            else:
                getattr(pfaff.Scene.from_string(text), kind)()
    except KeyboardInterrupt:
        print(time.monotonic() - sent[0])
"""


@POSIX
@pytest.mark.parametrize("kind", ["check", "analyze", "document", "matrices", "import", "simulate_of"])
def test_ctrl_c_is_heard_by_work_that_does_not_ask(kind: str) -> None:
    """Ctrl-C ends each call early. In the quick profile, an uninterrupted call takes some seconds."""
    text = chain(30_000)
    if kind == "import":
        body = "<body name='b{0}' pos='0 0 {0}'><joint type='hinge' axis='0 1 0'/><geom size='0.1' mass='1'/></body>"
        bodies = "".join(body.format(k) for k in range(30_000))
        text = f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"
    elif kind == "simulate_of":
        kind, text = "simulate", f"{text}\n[simulate]\nt_end = 1.0\n"
    child = [sys.executable, "-W", "error", "-c", textwrap.dedent(LONG), kind]
    begun = time.monotonic()
    done = subprocess.run(child, input=text, capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout, done.stderr
    # A computation that checks for Ctrl-C has 0.5 s to end; a busy machine needs more time.
    assert float(done.stdout) < 2.0
    assert time.monotonic() - begun < 60.0


def _answers(text: str) -> tuple[int, int, int, int]:
    """Returns results of a scene that are computed on several threads."""
    scene = pfaff.Scene.from_string(text)
    analysis = scene.analyze()
    pendulum = pfaff.Scene.from_string(PENDULUM)
    rows: list[float] = []
    runs = len(pendulum.simulate()), len(pendulum.simulate(on_row=rows.append))
    assert len(rows) == runs[0] == runs[1]
    assert len(analysis.document["reactions"]) == 600
    done = pendulum.sweep({"body.bob.mass": [1.0, 2.0]}).document["done"]
    return analysis.rank, runs[0], len(pendulum.tolerance(3, tolerance=1e-3)), done


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_computes() -> None:
    """The parent has started threads, which do not exist in a forked process."""
    text = chain(600)
    expected = _answers(text)
    with get_context("fork").Pool(2) as pool:
        asked = pool.map_async(_answers, [text] * 3)
        assert asked.get(timeout=60.0) == [expected] * 3
        # A worker computes again, after the parent has computed again.
        assert _answers(text) == expected
        assert pool.apply_async(_answers, [text]).get(timeout=60.0) == expected
