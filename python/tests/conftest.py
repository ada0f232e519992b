"""Scenes of the repository, and the command `pfaff`, if it is available."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROBOT = ROOT / "crates" / "robot-trolley" / "robot-trolley.toml"
EXAMPLES = [*sorted((ROOT / "examples").glob("*.toml")), ROBOT]

PENDULUM = """
scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "bob", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] }]
joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
simulate = { t_end = 1.0 }
"""

SLEIGH = """
scene = { name = "sleigh", space = "plane" }
body = [{ name = "sleigh", mass = 3.0, inertia = 1.0, velocity = [1.0, 0.0], angular_velocity = 0.5 }]
joint = [
    { name = "left", type = "knife-edge", body = "sleigh", at = [0.0, 0.3], normal = [0.0, 1.0] },
    { name = "right", type = "knife-edge", body = "sleigh", at = [0.0, -0.3], normal = [0.0, 1.0] },
]
simulate = { t_end = 2.0 }
"""

# A program that is started in the background of a shell ignores interrupts, and so do its children.
# The tests that interrupt would then never end.
signal.signal(signal.SIGINT, signal.default_int_handler)


def with_keywords(text: str) -> str:
    """Returns a text of the command with keywords in place of its options."""
    text = re.sub(r"`--([a-z][a-z-]*) ", lambda m: f"`{m[1].replace('-', '_')}=", text)
    return re.sub(r"--([a-z][a-z-]*)", lambda m: m[1].replace("-", "_"), text)


def _binary() -> Path | None:
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    named = os.environ.get("PFAFF_COMMAND")
    known = [Path(named)] if named else [target / kind / "pfaff" for kind in ("debug", "release")]
    return next((path for path in known if path.exists()), None)


class Command:
    """The command `pfaff`."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def run(self, *arguments: str | Path, stdin: str = "") -> subprocess.CompletedProcess[str]:
        """Returns the output for these arguments."""
        words = [str(self.path), *map(str, arguments)]
        return subprocess.run(
            words, input=stdin, capture_output=True, encoding="utf-8", check=False, timeout=600
        )

    def document(self, *arguments: str | Path, stdin: str = "") -> dict[str, Any]:
        """Returns the answer with `--json`."""
        document: dict[str, Any] = json.loads(self.run(*arguments, "--json", stdin=stdin).stdout)
        return document


@pytest.fixture(scope="session")
def command() -> Command:
    """Returns the command; without it, tests that compare with the command are skipped."""
    path = _binary()
    if path is None:
        pytest.skip("the command has not been built: cargo build -p pfaff-cli")
    return Command(path)


@pytest.fixture
def scene_file(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a text into a file."""

    def write(text: str) -> Path:
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write
