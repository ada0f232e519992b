"""Builds the wheel of the package and installs it into a separate environment.

The command `python python/build.py` works in any directory. The environment is
`python/target/venv`, and the wheel is written to `python/target/wheels`. `--quick` compiles faster
with little optimisation, for tests. It also generates the stubs of the private module from the
compiled module and compares the stubs with `package/pfaff/_pfaff.pyi`. `--write-stubs` writes the
stubs. `--portable` links for Linux systems with glibc 2.28 or later; without this option, the wheel
needs the glibc of this machine. The program needs Python >= 3.10 with venv and pip, and cargo. The
first run also needs the network.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGET = HERE / "target"
VENV = TARGET / "venv"
WHEELS = TARGET / "wheels"
STUBS = HERE / "package" / "pfaff" / "_pfaff.pyi"
HEADING = "# Written by `python python/build.py --write-stubs` from the compiled module.\n\n"
PORTABLE = ("--zig", "--compatibility", "manylinux_2_28")
"""Zig links against the symbols of an older glibc; maturin rejects a wheel with later symbols."""
LICENCES = ("LICENSE-APACHE", "LICENSE-MIT", "THIRD-PARTY.md")


def interpreter() -> Path:
    """The interpreter of the environment."""
    windows = VENV / "Scripts" / "python.exe"
    return windows if windows.exists() else VENV / "bin" / "python"


def run(*command: str | Path) -> None:
    """Prints and runs a command in this folder; if the command fails, exits with its code."""
    words = [str(word) for word in command]
    print("+", " ".join(words), flush=True)
    done = subprocess.run(words, cwd=HERE, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def environment(python: str) -> None:
    """Creates the environment if it does not exist, and installs the pinned packages."""
    if not interpreter().exists():
        run(python, "-m", "venv", VENV)
    pip = (interpreter(), "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    run(*pip, "--requirement", HERE / "requirements.txt")
    lines = (HERE / "engines.txt").read_text(encoding="utf-8").splitlines()
    for engine in (line for line in lines if not line.startswith("#")):
        words = [*map(str, pip), "--only-binary", ":all:", engine]
        print("+", " ".join(words), flush=True)
        if subprocess.run(words, cwd=HERE, check=False).returncode != 0:
            print(f"without {engine}: its tests will be skipped", flush=True)


def wheel(profile: str, extra: Sequence[str]) -> Path:
    """Builds the wheel."""
    shutil.rmtree(WHEELS, ignore_errors=True)
    for name in LICENCES:
        shutil.copyfile(HERE.parent / name, HERE / name)
    options = ["--profile", profile, "--out", str(WHEELS), "--compression-level", "9"]
    if profile == "release":
        options.append("--strip")
    begun = time.monotonic()
    try:
        run(interpreter(), "-m", "maturin", "build", *options, *extra)
    finally:
        for name in LICENCES:
            (HERE / name).unlink()
    (made,) = WHEELS.glob("*.whl")
    size = made.stat().st_size / 1e6
    print(f"{made.name}: {size:.2f} MB in {time.monotonic() - begun:.0f} s", flush=True)
    return made


def stubs(profile: str, write: bool) -> None:
    """Compares the stubs of the private module with the compiled module, or writes the stubs.

    For a release, the crate would have to be compiled again: the stubs are read from symbols that
    the wheel of a release does not contain. For a release, `test.py` compares the stubs with the
    module.
    """
    folder = TARGET / "stubs"
    shutil.rmtree(folder, ignore_errors=True)
    options = ("--profile", profile, "--out", folder)
    run(interpreter(), "-m", "maturin", "generate-stubs", *options)
    (made,) = folder.rglob("*.pyi")
    text = HEADING + made.read_text(encoding="utf-8")
    if write:
        STUBS.write_text(text, encoding="utf-8")
    elif text != STUBS.read_text(encoding="utf-8"):
        sys.exit(f"{STUBS} is not that of the module: build.py --write-stubs writes it")


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--python", default=sys.executable, help="interpreter of the environment")
    parser.add_argument("--quick", action="store_true", help="compile faster, for tests")
    parser.add_argument("--portable", action="store_true", help="link for glibc 2.28 and later")
    parser.add_argument("--write-stubs", action="store_true", help="write the stubs anew, quickly")
    parser.add_argument("--environment", action="store_true", help="make the environment alone")
    arguments = parser.parse_args()
    environment(arguments.python)
    if arguments.environment:
        return
    profile = "quick" if arguments.quick or arguments.write_stubs else "release"
    if arguments.portable:
        # Maturin searches for Zig in this directory.
        os.environ["PATH"] = os.pathsep.join((str(interpreter().parent), os.environ["PATH"]))
        requirements = ("--requirement", HERE / "requirements-release.txt")
        run(interpreter(), "-m", "pip", "install", "--quiet", *requirements)
    made = wheel(profile, PORTABLE if arguments.portable else ())
    if profile == "quick":
        stubs(profile, arguments.write_stubs)
    pip = (interpreter(), "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    run(*pip, "--force-reinstall", "--no-deps", made)


if __name__ == "__main__":
    main()
