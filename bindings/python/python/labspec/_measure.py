"""Measures of runs, in this process: what :func:`labspec.sweep` and :meth:`labspec.Lab.run` perform."""

from __future__ import annotations

import json
from typing import Any

from . import _labspec
from ._recording import Value

#: The lab in the lab format, its models, the measures, and the end of the runs, s.
Work = tuple[dict[str, Any], Any, dict[str, str], float | None]
#: The measures of a run, or why it has none.
Result = tuple[list[float], str | None]
Runs = list[dict[str, Value]]


def measure_runs(work: Work, runs: Runs, workers: int = 1) -> list[Result]:
    """Measures runs, in order; on all cores if ``workers`` is 0."""
    lab, models, measures, until = work
    end = {} if until is None else {"until": until}

    def text(run: dict[str, Value]) -> str:
        verify = {"runs": {"run": {"set": run, **end}}, "measure": measures}
        return json.dumps({**lab, "verify": verify})

    return _labspec.measure([text(run) for run in runs], models, workers)


def measure_task(task: tuple[Work, Runs]) -> list[Result]:
    """Measures the runs of a task, which can be pickled."""
    return measure_runs(*task)
