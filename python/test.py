"""Tests the package that `build.py` has installed: pytest with warnings as errors, mypy, stubtest.

The command is `python python/test.py`; further arguments are passed to pytest. If cargo has built
the command `pfaff`, or `PFAFF_COMMAND` contains its path, the results are compared with the results
of the command.
"""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from build import HERE, interpreter, run


def checked(*command: str) -> subprocess.CompletedProcess[str]:
    """Runs a module of the environment that checks the package."""
    words = [str(interpreter()), "-m", *command]
    return subprocess.run(words, cwd=HERE, check=False, capture_output=True, text=True)


def main() -> None:
    """The command line."""
    if not interpreter().exists():
        sys.exit("there is no environment: run build.py first")
    config = str(HERE / "pyproject.toml")
    checks = [("mypy",), ("mypy.stubtest", "pfaff", "--mypy-config-file", config)]
    # Types are checked while tests wait for workers of a cluster.
    with ThreadPoolExecutor(1) as pool:
        found = [pool.submit(checked, *check) for check in checks]
        run(interpreter(), "-m", "pytest", *sys.argv[1:])
    for check, result in zip(checks, [future.result() for future in found], strict=True):
        print("+", *check, "\n" + result.stdout + result.stderr, flush=True)
    sys.exit(any(future.result().returncode != 0 for future in found))


if __name__ == "__main__":
    main()
