"""Tests copies of results, and pickles of results for pools of processes."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import pytest
from conftest import PENDULUM, SLEIGH

import pfaff

WAYS: dict[str, Callable[[Any], Any]] = {
    f"pickle {protocol}": lambda of, protocol=protocol: pickle.loads(pickle.dumps(of, protocol))
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)
} | {"copy": copy.copy, "deepcopy": copy.deepcopy}


def sleigh() -> pfaff.Analysis:
    """Returns a new analysis, from which no result has been requested."""
    return pfaff.Scene.from_string(SLEIGH).analyze()


def questions(of: pfaff.Analysis) -> list[Any]:
    """Returns results of an analysis: texts, the document, and results of further computation."""
    left = of.verdicts["left"]
    return [
        repr(of),
        repr(of.verdicts),
        (of.q.tolist(), of.v.tolist(), of.warnings, of.explain()),
        of.document,
        (left.verdict, left.margin, left.rows, left.components, left.explain(), left.document),
        of.combine("left.N + right.N"),
        of.moment("left", [0.0, 0.0]),
        of.make_unique("left"),
        of.eliminations(),
        of.reactions("minimum-norm"),
        of.along(0.5),
    ]


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
def test_an_analysis_answers_the_same_again(way: Callable[[Any], Any]) -> None:
    expected = questions(sleigh())
    assert questions(way(sleigh())) == expected
    asked = sleigh()
    questions(asked)
    again = way(way(asked))
    assert questions(again) == expected
    with pytest.raises(pfaff.InputError, match="did you mean `left`"):
        again.verdicts["lefd"]


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
def test_a_verdict_answers_the_same_again(way: Callable[[Any], Any]) -> None:
    expected = sleigh().verdicts["left"]
    again = way(sleigh().verdicts["left"])
    assert again.verdict == expected.verdict and again.document == expected.document
    assert again.moment([0.0, 0.0]) == expected.moment([0.0, 0.0])
    assert again.make_unique() == expected.make_unique()


def test_a_pickle_has_what_was_computed() -> None:
    """Reading a pickle computes nothing: its analysis would now be rejected or would take long."""
    analysis = sleigh()
    document = analysis.document
    dumped = pickle.dumps(analysis)
    with pytest.MonkeyPatch.context() as patch:
        patch.delattr(pfaff.Scene, "_asked")
        again = pickle.loads(dumped)
        assert again.document == document
        assert again.verdicts["left"].document == document["reactions"][0]
        assert (again.rank, repr(again)) == (analysis.rank, repr(analysis))
    assert again.eliminations() == analysis.eliminations()


def test_an_analysis_at_another_time_keeps_it() -> None:
    scene = pfaff.Scene.from_string(SLEIGH)
    at = scene.analyze(0.7, tolerance=1e-4, drop=[1])
    again = pickle.loads(pickle.dumps(at))
    np.testing.assert_array_equal(again.q, at.q)
    assert again.document == at.document
    assert again.combine("left.N + right.N") == at.combine("left.N + right.N")


def _same(one: Any, other: Any) -> None:
    """Checks that all attributes agree; arrays agree bit by bit."""
    assert type(one) is type(other)
    own, others = vars(one), vars(other)
    assert own.keys() == others.keys()
    for name, value in own.items():
        if isinstance(value, np.ndarray):
            np.testing.assert_array_equal(value, others[name], err_msg=name)
            assert value.flags.writeable == others[name].flags.writeable, name
        elif isinstance(value, (str, float, list, dict, pfaff.Scene)) and name not in ("table", "choices"):
            assert repr(value) == repr(others[name]) or name.startswith("_"), name


RESULTS: dict[str, Callable[[pfaff.Scene], Any]] = {
    "run": lambda scene: scene.simulate(),
    "run with a choice": lambda scene: scene.simulate(choose=["minimum-norm"]),
    "samples": lambda scene: scene.tolerance(5, tolerance=1e-3),
    "linearisation": lambda scene: scene.linearise(),
    "work and precision": lambda scene: scene.work_precision(quick=True),
    "sweep": lambda scene: scene.sweep("body.bob.mass=1,2"),
}


@pytest.mark.parametrize("make", RESULTS.values(), ids=RESULTS.keys())
@pytest.mark.parametrize("way", [WAYS["pickle 5"], copy.copy, copy.deepcopy], ids=["pickle", "copy", "deepcopy"])
def test_other_results(make: Callable[[pfaff.Scene], Any], way: Callable[[Any], Any]) -> None:
    at_rest = PENDULUM.replace("position = [1.0, 0.0]", "position = [0.0, -1.0]")
    result = make(pfaff.Scene.from_string(at_rest))
    again = way(result)
    _same(result, again)
    for name, column in getattr(result, "table", {}).items():
        np.testing.assert_array_equal(column, again.table[name])
        assert column.flags.writeable == again.table[name].flags.writeable
    if isinstance(result, pfaff.Run):
        np.testing.assert_array_equal(result.body("bob").position, again.body("bob").position)
        assert np.shares_memory(again.body("bob").position, again.trajectory)


def test_matrices_and_events() -> None:
    matrices = pfaff.Scene.from_string(PENDULUM).matrices()
    for one, other in zip(matrices, pickle.loads(pickle.dumps(matrices)), strict=True):
        np.testing.assert_array_equal(one, other)


def test_an_error_keeps_its_run() -> None:
    with pytest.raises(pfaff.ComputationError) as raised:
        pfaff.Scene.from_string(PENDULUM).simulate(100.0, max_steps=20, rtol=1e-12)
    error = raised.value
    assert error.run is not None
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.code) == (str(error), error.code)
    np.testing.assert_array_equal(again.run.t, error.run.t)


def test_a_pool_of_processes_returns_analyses() -> None:
    scenes = [pfaff.Scene.from_string(text) for text in (PENDULUM, SLEIGH)]
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(pfaff.Scene.analyze, scenes))
    assert [analysis.document for analysis in found] == [scene.analyze().document for scene in scenes]
