"""Sweeps: measures of many runs of a lab, on the cores of this machine or on any executor."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _charts, _html
from ._effects import Effects, effects_of, varied
from ._lab import Lab
from ._measure import Result, Runs, Work, measure_runs, measure_task
from ._recording import Value
from ._stored import StoredSweep

#: Measures with a tornado chart in a notebook, and values on a side of a map there.
_MOST_TORNADOS, _MOST_CELLS = 3, 50
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
    #: The values of the controls of the lab at its start, which a run has unless ``params`` name another one.
    starts: Mapping[str, Value] = field(default_factory=dict, repr=False, compare=False)

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

    def effects(self, measure: str | None = None, *, base: Mapping[str, Value] | None = None) -> Effects:
        """How a measure, by default the first one, changes with each control.

        The means of the measure over all runs with the same value of a control are compared; of more than eight numbers, those of four groups. With
        ``base``, or if all runs differ from the first one in one control at most, only runs that differ from it in this control are compared.
        """
        name, settings = self._measure(measure), self._settings()
        unknown = [label for label in base or {} if label not in self.starts and not any(label in run for run in settings)]
        if unknown:
            raise KeyError(f'no run has a value of "{unknown[0]}"')
        full = {**self.starts, **base} if base is not None else None
        return effects_of(name, settings, self.values[name].tolist(), full)

    def tornado(self, measure: str | None = None, *, base: Mapping[str, Value] | None = None) -> str:
        """The effects of all controls as a tornado chart, SVG: a bar for each control, the largest on top."""
        return _charts.tornado(self.effects(measure, base=base))

    def map(self, x: str, y: str, measure: str | None = None, *, at: Mapping[str, Value] | None = None) -> str:
        """A measure over the values of two controls as colours, SVG. ``at`` chooses the runs with these values of the other controls."""
        name, cells = self._measure(measure), {}
        for run, value, error in zip(self._settings(), self.values[name].tolist(), self.errors, strict=True):
            if any(run.get(label) != wanted for label, wanted in (at or {}).items()):
                continue
            missing = [label for label in (x, y) if label not in run]
            if missing:
                raise KeyError(f'no run has a value of "{missing[0]}"')
            pair = run[x], run[y]
            if pair in cells:
                raise ValueError(f"several runs have {x} = {pair[0]} and {y} = {pair[1]}: choose the values of the other controls with `at`")
            cells[pair] = value, error
        if not cells:
            raise ValueError("no run has these values")
        return _charts.cell_map(x, y, name, cells)

    def parallel(self, *, by: str | None = None) -> str:
        """All runs as lines over parallel axes, for each control that varies and each measure, SVG. The measure ``by`` gives the colours."""
        settings, name = self._settings(), self._measure(by)
        controls = {label: [run.get(label, "?") for run in settings] for label in varied(settings)}
        return _charts.parallel(controls | {measure: values.tolist() for measure, values in self.values.items()}, name)

    def _measure(self, name: str | None) -> str:
        if not self.values or name is not None and name not in self.values:
            raise KeyError(f'the sweep has no measure "{name}"; it has {", ".join(self.values)}' if self.values else "the sweep has no measure")
        return next(iter(self.values)) if name is None else name

    def _settings(self) -> list[dict[str, Value]]:
        """The values of the controls of each run, with those of the start."""
        labels = dict.fromkeys(label for run in self.params for label in run)
        every = ({label: run.get(label, self.starts.get(label)) for label in labels} for run in self.params)
        return [{label: value for label, value in run.items() if value is not None} for run in every]

    def _repr_html_(self) -> str:
        columns = self.columns()
        failed = sum(error is not None for error in self.errors)
        heading = _html.heading("Sweep", f"{len(self)} runs", f"{failed} without measures" if failed else "")
        pictures = "".join(_html.picture(svg, what) for what, svg in self._pictures())
        return heading + pictures + _html.table(list(columns), zip(*columns.values(), strict=True))

    def _pictures(self) -> Iterator[tuple[str, str]]:
        """The charts for a notebook, if two controls vary or more."""
        settings = self._settings()
        labels = varied(settings)
        if len(labels) < 2 or not self.values or any(label not in run for run in settings for label in labels):
            return
        for name in list(self.values)[:_MOST_TORNADOS]:
            yield f"effects on {name}", self.tornado(name)
        pairs = {(run[labels[0]], run[labels[1]]) for run in settings}
        sides = [len({run[label] for run in settings}) for label in labels]
        if len(labels) == 2 and len(pairs) == len(self) == sides[0] * sides[1] and max(sides) <= _MOST_CELLS:
            yield f"map of {next(iter(self.values))}", self.map(labels[0], labels[1])
        yield "runs on parallel axes", self.parallel()


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
    starts = {control.label: control.start for control in lab.controls if control.kind != "button"}
    values = {name: table[:, i].copy() for i, name in enumerate(names)}
    return Sweep(tuple(runs), values, tuple(error for _values, error in results), starts)


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
        raise TypeError("the executor must have `map` or `submit`, or be a `Parallel` of joblib")
