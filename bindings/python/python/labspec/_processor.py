"""The build of ``labspec._labspec`` for this processor.

A wheel for Linux on x86-64 contains the module twice: beside this file for every processor, and in the folder ``x86-64-v3`` with the
vector instructions of processors since 2013. Results are the same.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

from . import _labspec


def faster(module: ModuleType) -> ModuleType | None:
    """The faster build of a module, if the package contains one. It has the name of the module."""
    beside = Path(module.__file__ or "")
    spec = importlib.util.spec_from_file_location(module.__name__, beside.parent / "x86-64-v3" / beside.name)
    if spec is None or spec.loader is None or not Path(spec.origin or "").is_file():
        return None
    built = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(built)
    return built


def use(module: ModuleType) -> None:
    """Makes a module the one that ``from . import`` finds."""
    sys.modules[module.__name__] = module
    package, _, name = module.__name__.rpartition(".")
    setattr(sys.modules[package], name, module)


if _labspec.runs_faster_build() and (built := faster(_labspec)) is not None:
    use(built)
