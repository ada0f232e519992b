"""The result of one integration."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mechanism import Array


@dataclass(frozen=True)
class Outcome:
    """Positions of the watched points at the reached instants, and the run time.

    `seconds` is the wall time of the integration alone. `other_clock` is the time of the whole
    program if the engine is a program, and the time of the accelerations alone if the integration
    loop is ours. `note` states why a run stopped early.
    """

    places: Array
    seconds: float
    other_clock: float | None = None
    note: str = ""


Run = Callable[[], Outcome]

FAR = 1e3
"""Distance from the origin (m) above which a run counts as diverged."""


def sampled(count: int, advance: Callable[[int], None], places: Callable[[], Array]) -> Outcome:
    """Advances to each instant in turn and records the positions; only the advancing is timed."""
    rows: list[Array] = []
    note = ""
    begin = time.perf_counter()
    for k in range(count):
        advance(k)
        rows.append(places())
        if not np.isfinite(rows[-1]).all() or np.abs(rows[-1]).max() > FAR:
            note = "blew up"
            break
    return Outcome(np.array(rows), time.perf_counter() - begin, note=note)
