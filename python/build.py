"""Builds the wheel of the package and installs it into an environment of its own.

`python python/build.py` from the root, or from anywhere: the environment is `python/target/venv`,
the wheel goes to `python/target/wheels`. `--python PATH` takes another interpreter, `--debug` builds
without optimisation. Needs Python >= 3.10 with venv and pip, cargo, and on the first run the network.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGET = HERE / "target"
VENV = TARGET / "venv"
WHEELS = TARGET / "wheels"
LICENCES = ("LICENSE-APACHE", "LICENSE-MIT")


def interpreter() -> Path:
    """The interpreter of the environment."""
    windows = VENV / "Scripts" / "python.exe"
    return windows if windows.exists() else VENV / "bin" / "python"


def run(*command: str | Path) -> None:
    """Runs a command in this folder, shows it, and ends with its code if it fails."""
    words = [str(word) for word in command]
    print("+", " ".join(words), flush=True)
    done = subprocess.run(words, cwd=HERE, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def environment(python: str) -> None:
    """Makes the environment, if it is not there, and installs what is pinned."""
    if not interpreter().exists():
        run(python, "-m", "venv", VENV)
    pip = (interpreter(), "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    run(*pip, "--requirement", HERE / "requirements.txt")


def wheel(debug: bool) -> Path:
    """Builds the wheel."""
    shutil.rmtree(WHEELS, ignore_errors=True)
    for name in LICENCES:
        shutil.copyfile(HERE.parent / name, HERE / name)
    profile = () if debug else ("--release",)
    begun = time.monotonic()
    try:
        run(interpreter(), "-m", "maturin", "build", *profile, "--out", WHEELS)
    finally:
        for name in LICENCES:
            (HERE / name).unlink()
    (made,) = WHEELS.glob("*.whl")
    size = made.stat().st_size / 1e6
    print(f"{made.name}: {size:.2f} MB in {time.monotonic() - begun:.0f} s", flush=True)
    return made


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--python", default=sys.executable, help="interpreter of the environment")
    parser.add_argument("--debug", action="store_true", help="without optimisation")
    arguments = parser.parse_args()
    environment(arguments.python)
    made = wheel(arguments.debug)
    pip = (interpreter(), "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    run(*pip, "--force-reinstall", "--no-deps", made)


if __name__ == "__main__":
    main()
