"""Sweeps: measures of many runs of a lab, on the cores of this machine or on any executor."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _labspec
from ._lab import Lab, Value

#: Runs that an executor gets at once.
_CHUNK = 16


class _Maps(Protocol):
    def map(self, fn: Callable[..., Any], /, *iterables: Iterable[Any]) -> Iterable[Any]: ...


class _Submits(Protocol):
    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Any: ...


@dataclass(frozen=True)
class Sweep:
    """The runs of a sweep, in order: for each, the values of the controls, the measures, and why it has none."""

    params: tuple[Mapping[str, Value], ...]
    values: Mapping[str, NDArray[np.float64]]
    errors: tuple[str | None, ...]

    def __len__(self) -> int:
        return len(self.params)

    def __getitem__(self, measure: str) -> NDArray[np.float64]:
        """A measure of all runs; NaN for a run that has none."""
        return self.values[measure]

    def columns(self) -> dict[str, list[Any]]:
        """The controls, then the measures, as columns for a table."""
        labels = dict.fromkeys(label for run in self.params for label in run)
        controls = {label: [run.get(label) for run in self.params] for label in labels}
        return controls | {name: values.tolist() for name, values in self.values.items()}


def sweep(
    lab: Lab,
    over: Mapping[str, Sequence[Value]] | Iterable[Mapping[str, Value]],
    measures: Mapping[str, str],
    *,
    until: float | None = None,
    executor: _Maps | _Submits | None = None,
) -> Sweep:
    """Runs a lab with many values of its controls, and measures each run.

    ``over`` is a grid, such as ``{"mass": [1, 2], "angle": [20, 30, 40]}``, or the values of each run. ``measures`` are those of a
    ``verify`` object: ``{"lands": "first(contact('ball', 'floor'))"}``. A run ends at ``until``, s, or as the lab does.

    Without an executor all cores of this machine are used. Otherwise the executor has ``map`` or ``submit``: of ``concurrent.futures``,
    joblib's, a ``Client`` of Dask, a pool of Ray. The result is the same.
    """
    runs = [dict(zip(over, values, strict=True)) for values in product(*over.values())] if isinstance(over, Mapping) else [dict(run) for run in over]
    work = (lab.json, lab._source[-1], dict(measures), until)
    if executor is None:
        results = _measure(work, runs, workers=0)
    else:
        chunks = [runs[i : i + _CHUNK] for i in range(0, len(runs), _CHUNK)]
        results = [result for chunk in _mapped(executor, work, chunks) for result in chunk]
    names = list(measures)
    table = np.array([values if error is None else [np.nan] * len(names) for values, error in results], float)
    table = table.reshape(len(runs), len(names))
    return Sweep(
        tuple(runs), {name: table[:, i].copy() for i, name in enumerate(names)}, tuple(error for _values, error in results)
    )


_Work = tuple[dict[str, Any], Any, dict[str, str], float | None]
_Result = tuple[list[float], str | None]


def _measure(work: _Work, runs: list[dict[str, Value]], workers: int = 1) -> list[_Result]:
    """Measures runs, in this process."""
    lab, models, measures, until = work
    end = {} if until is None else {"until": until}

    def text(run: dict[str, Value]) -> str:
        verify = {"runs": {"run": {"set": run, **end}}, "measure": measures}
        return json.dumps({**lab, "verify": verify})

    return _labspec.measure([text(run) for run in runs], models, workers)


def _mapped(executor: Any, work: _Work, chunks: list[list[dict[str, Value]]]) -> list[list[_Result]]:
    all_work = [work] * len(chunks)
    if hasattr(executor, "submit"):
        futures = [executor.submit(_measure, work, chunk) for chunk in chunks]
        return [future.result() for future in futures]
    found = executor.map(_measure, all_work, chunks)
    return [chunk.result() if hasattr(chunk, "result") else chunk for chunk in found]
