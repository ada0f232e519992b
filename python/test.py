"""Tests the package that `build.py` has installed: pytest with warnings as errors, mypy, stubtest.

`python python/test.py`; what follows goes to pytest. If the command `pfaff` has been built by cargo,
or `PFAFF_COMMAND` names it, answers are compared with its answers.
"""

from __future__ import annotations

import sys

from build import HERE, interpreter, run


def main() -> None:
    """The command line."""
    if not interpreter().exists():
        sys.exit("there is no environment: run build.py first")
    run(interpreter(), "-m", "pytest", *sys.argv[1:])
    run(interpreter(), "-m", "mypy")
    config = HERE / "pyproject.toml"
    run(interpreter(), "-m", "mypy.stubtest", "pfaff", "--mypy-config-file", config)


if __name__ == "__main__":
    main()
