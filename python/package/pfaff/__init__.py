"""Mechanisms with redundant constraints: their motion, and which joint reactions are unique.

>>> import pfaff
>>> door = (
...     pfaff.Scene("door on two hinges", space="plane")
...     .body("leaf", mass=20.0, inertia=5.0)
...     .joint("upper", "revolute", ["ground", "leaf"], at=[0.0, 1.0])
...     .joint("lower", "revolute", ["ground", "leaf"], at=[0.0, -1.0])
... )
>>> door.analyze().verdicts["upper"].unique
False

A scene is an immutable text in the format of scene files: methods return new scenes. The results
are the same as the results of the command ``pfaff``, in SI units and radians. See
``docs/book/python.md``.
"""

from . import cluster
from ._analysis import Analysis, ComponentVerdict, GroupVerdict, Verdict
from ._comparison import Curve, WorkPrecision
from ._errors import (
    ArgumentError,
    ComputationError,
    Error,
    InputError,
    InternalError,
    Place,
    SceneError,
)
from ._functions import BodyState
from ._linearisation import Linearisation
from ._pfaff import __version__, explain
from ._run import BodyMotion, ChosenReactions, Event, Load, Reaction, Run
from ._samples import Samples
from ._scene import Matrices, Scene, templates
from ._simulator import Simulator
from ._state import ReactionNumber, State
from .cluster import SweepResult

__all__ = [
    "Analysis",
    "ArgumentError",
    "BodyMotion",
    "BodyState",
    "ChosenReactions",
    "ComponentVerdict",
    "ComputationError",
    "Curve",
    "Error",
    "Event",
    "GroupVerdict",
    "InputError",
    "InternalError",
    "Linearisation",
    "Load",
    "Matrices",
    "Place",
    "Reaction",
    "ReactionNumber",
    "Run",
    "Samples",
    "Scene",
    "SceneError",
    "Simulator",
    "State",
    "SweepResult",
    "Verdict",
    "WorkPrecision",
    "__version__",
    "cluster",
    "explain",
    "templates",
]
