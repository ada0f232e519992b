"""What one integration gives back."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mechanism import Array


@dataclass(frozen=True)
class Outcome:
    """Places of the watched points at the instants reached, and the time it took.

    `seconds` is the wall time of the integration alone. `other_clock` is that of the whole
    program where the engine is one, and that of the accelerations alone where the loop around
    them is ours. `note` says why a run stopped early.
    """

    places: Array
    seconds: float
    other_clock: float | None = None
    note: str = ""


Run = Callable[[], Outcome]

FAR = 1e3
"""Places farther than this from the origin are those of a run that has blown up (m)."""


def sampled(count: int, advance: Callable[[int], None], places: Callable[[], Array]) -> Outcome:
    """Advances to each instant in turn and notes the places there; only that is timed."""
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
