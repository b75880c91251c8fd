"""The ``labspec`` program: ``python -m labspec check lessons``, and the script ``labspec``."""

from __future__ import annotations

import signal
import sys

from ._labspec import run_program


def main() -> int:
    """Runs the program with the arguments of this process, and returns its exit code."""
    # Ctrl-C belongs to the program, which prints what it has finished.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run_program(["labspec", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
