"""A process that runs one engine; it reads orders and writes answers as lines of JSON.

For each order {scene, count, nearby, options, step, is_tolerance} there are two answers: {ready}
after the model is built, and the row of the run. A crash ends only this process.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import sys
import tempfile
from functools import lru_cache

import scenes
from mechanism import Mechanism


@lru_cache(maxsize=4)
def mechanism(scene: str, count: int, nearby: int) -> Mechanism:
    """Returns the scene, with its reference."""
    return scenes.make(scene, count, nearby)


def answer(engine: object, order: dict, tell: callable) -> dict:
    """Prepares and performs the run; returns the row without the entries of the order."""
    made = mechanism(order["scene"], order["count"], order["nearby"])
    step = order["step"] if order["is_tolerance"] else made.interval / order["step"]
    step *= 1.0 + 0.01 * order["nearby"]
    run = engine.prepare(made, order["options"], step)
    tell({"ready": True})
    outcome = run()
    reached = len(outcome.places)
    error = made.error(outcome.places)
    whole = reached == made.samples and math.isfinite(error)
    return {
        "status": "done" if whole else "stopped",
        "seconds": outcome.seconds,
        "other_clock": outcome.other_clock,
        "error": error if math.isfinite(error) else None,
        "reached": reached * made.interval,
        "note": outcome.note,
    }


def serve(name: str, core: int) -> None:
    """Executes orders until the input ends."""
    os.sched_setaffinity(0, {core})
    # Engines may print any text; only our answers go to the pipe.
    pipe = os.fdopen(os.dup(1), "w")
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)
    os.dup2(silent, 2)

    def tell(document: dict) -> None:
        pipe.write(json.dumps(document) + "\n")
        pipe.flush()

    engine = importlib.import_module(f"with_{name}")
    # MuJoCo writes a log into the current directory.
    os.chdir(tempfile.gettempdir())
    tell({"version": engine.version()})
    for line in sys.stdin:
        order = json.loads(line)
        try:
            tell(answer(engine, order, tell))
        except Exception as error:  # if an engine rejects a scene, that is a result, too
            note = " ".join(str(error).split())[:160] or type(error).__name__
            tell({"status": "refused", "note": note})


if __name__ == "__main__":
    serve(sys.argv[1], int(sys.argv[2]))
