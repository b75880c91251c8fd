"""Sweeps: measures of many runs of a lab, on the cores of this machine or on any executor."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _html
from ._lab import Lab
from ._measure import Result, Runs, Work, measure_runs, measure_task
from ._recording import Value
from ._stored import StoredSweep

#: Runs that an executor gets at once.
_CHUNK = 16
#: Runs of a file of a stored sweep, whatever the executor.
_STORED = 64


class _Maps(Protocol):
    def map(self, fn: Callable[..., Any], /, *iterables: Iterable[Any]) -> Iterable[Any]: ...


class _Submits(Protocol):
    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Any: ...


class _Calls(Protocol):
    n_jobs: Any

    def __call__(self, iterable: Iterable[Any], /) -> Any: ...


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

    def _repr_html_(self) -> str:
        columns = self.columns()
        failed = sum(error is not None for error in self.errors)
        return _html.heading("Sweep", f"{len(self)} runs", f"{failed} without measures" if failed else "") + _html.table(
            list(columns), zip(*columns.values(), strict=True)
        )


def sweep(
    lab: Lab,
    over: Mapping[str, Sequence[Value]] | Iterable[Mapping[str, Value]],
    measures: Mapping[str, str],
    *,
    until: float | None = None,
    executor: _Maps | _Submits | _Calls | None = None,
    out: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Sweep:
    """Runs a lab with many values of its controls, and measures each run.

    ``over`` is a grid, such as ``{"mass": [1, 2], "angle": [20, 30, 40]}``, or the values of each run, such as those of :func:`sobol`. ``measures`` are
    those of a ``verify`` object: ``{"lands": "first(contact('ball', 'floor'))"}``. A run ends at ``until``, s, or as the lab does.

    Without an executor all cores of this machine are used. Otherwise the executor has ``map`` or ``submit`` (``concurrent.futures``, a ``Client`` of
    Dask, a pool of ``multiprocessing`` or of Ray), or it is a ``Parallel`` of joblib. The result is the same.

    ``out`` is a folder, into which the runs are written as Parquet, a file for some of them each (it needs ``pyarrow``). A sweep that was killed
    continues there: what is written is not run again. ``progress`` is called with the number of finished runs, and of all.
    """
    runs = [dict(zip(over, values, strict=True)) for values in product(*over.values())] if isinstance(over, Mapping) else [dict(run) for run in over]
    work = (lab.json, lab._source[-1], dict(measures), until)
    names = list(measures)
    stored = StoredSweep(os.fspath(out), lab, runs, names, work) if out is not None else None
    results = _finished(work, runs, executor, stored, progress)
    table = np.array([values if error is None else [np.nan] * len(names) for values, error in results], float)
    table = table.reshape(len(runs), len(names))
    return Sweep(
        tuple(runs), {name: table[:, i].copy() for i, name in enumerate(names)}, tuple(error for _values, error in results)
    )


def _finished(
    work: Work, runs: Runs, executor: Any, stored: StoredSweep | None, progress: Callable[[int, int], object] | None
) -> list[Result]:
    """The results of all runs, in order. Those of a stored sweep that were written are read."""
    size = _STORED if stored is not None else _CHUNK if executor is not None else len(runs) if progress is None else _STORED
    chunks = [runs[i : i + size] for i in range(0, len(runs), max(size, 1))]
    found = {i: results for i in range(len(chunks)) if stored is not None and (results := stored.read(i, chunks[i])) is not None}
    left = [i for i in range(len(chunks)) if i not in found]
    done = sum(map(len, found.values()))
    for i, results in zip(left, _mapped(executor, work, [chunks[i] for i in left]), strict=True):
        found[i] = results
        if stored is not None:
            stored.write(i, chunks[i], results)
        done += len(results)
        if progress is not None:
            progress(done, len(runs))
    return [result for i in range(len(chunks)) for result in found[i]]


def _mapped(executor: Any, work: Work, chunks: list[Runs]) -> Iterator[list[Result]]:
    """The results of chunks, in order, as they are finished."""
    tasks = [(work, chunk) for chunk in chunks]
    if executor is None:
        yield from (measure_runs(work, chunk, workers=0) for chunk in chunks)
    elif hasattr(executor, "submit"):
        futures = [executor.submit(measure_task, task) for task in tasks]
        yield from (future.result() for future in futures)
    elif hasattr(executor, "map"):
        found = executor.map(measure_task, tasks)
        yield from (chunk.result() if hasattr(chunk, "result") else chunk for chunk in found)
    elif hasattr(executor, "n_jobs") and callable(executor):
        # What `joblib.delayed` makes of a call.
        yield from executor([(measure_task, (task,), {}) for task in tasks])
    else:
        raise TypeError("an executor has `map` or `submit`, or is a `Parallel` of joblib")
