"""Labs: what a student can do on a page, and what the page displays."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _labspec
from ._check import Finding, models_near
from ._engine import Files, Model

Value = float | str | bool


@dataclass(frozen=True)
class Control:
    """A slider, a select or a button."""

    label: str
    kind: str
    start: Value
    unit: str = ""
    min: float | None = None
    max: float | None = None
    step: float | None = None
    digits: int | None = None
    options: tuple[tuple[str, Value], ...] = ()


@dataclass(frozen=True)
class Displayed:
    """A trace of a plot, or a readout."""

    label: str
    unit: str
    kind: str
    #: The plot of a trace, from 0.
    plot: int | None
    #: The decimals of a readout.
    digits: int | None


@dataclass(frozen=True)
class Recording:
    """The displayed values of a run: a row for each sample, a column for each value; NaN where a value is no number."""

    times: NDArray[np.float64]
    values: NDArray[np.float64]
    displayed: tuple[Displayed, ...]

    def __getitem__(self, label: str) -> NDArray[np.float64]:
        """The column with this label."""
        for i, displayed in enumerate(self.displayed):
            if displayed.label == label:
                return self.values[:, i]
        raise KeyError(f'nothing is displayed as "{label}"; use one of {", ".join(d.label for d in self.displayed)}')

    def __len__(self) -> int:
        return len(self.times)


class Lab:
    """A lab that is open. ``lab["mass"] = 2`` moves a slider, ``lab["mass"]`` reads it."""

    __slots__ = ("_native", "_source")
    _native: _labspec.Lab
    _source: tuple[Any, ...]

    def __init__(self, lab: str | os.PathLike[str] | Mapping[str, Any], models: Files = None) -> None:
        """Opens ``lesson.md#2``, ``lesson.md#quiz-id.1`` or ``lab.json``, or a lab as a dictionary.

        ``models`` is a folder of models, or MJCF by name; by default the folder ``models`` beside or above the file.
        """
        if isinstance(lab, Mapping):
            source: tuple[Any, ...] = (json.dumps(lab), models)
            native = _labspec.Lab.from_json(*source)
        else:
            name, _, address = os.fspath(lab).partition("#")
            if Path(os.fspath(lab)).exists():
                name, address = os.fspath(lab), ""
            path = Path(name)
            models = models if models is not None else models_near(path)
            text = path.read_text(encoding="utf-8")
            if path.suffix == ".json" and not address:
                source = (text, models)
                native = _labspec.Lab.from_json(*source)
            else:
                source = (name, text, f"#{address or 1}", models)
                native = _labspec.Lab.from_lesson(*source)
        self._native = native
        self._source = source

    def __reduce__(self) -> Any:
        return _opened, (self._source,)

    @property
    def json(self) -> dict[str, Any]:
        """The lab as a dictionary."""
        return _dictionary(self._source)

    @property
    def time(self) -> float:
        """The simulated time, s."""
        return self._native.time

    @property
    def timestep(self) -> float:
        """The length of a step, s."""
        return self._native.timestep

    @property
    def is_over(self) -> bool:
        """Whether it does not continue without a reset: it reached its ``stopAt``, or an error of its programs froze it."""
        return self._native.is_over

    @property
    def controls(self) -> tuple[Control, ...]:
        """The sliders, selects and buttons."""
        return tuple(
            Control(**{**c, "options": tuple(c.get("options", ()))}) for c in self._native.controls()
        )

    @property
    def displayed(self) -> tuple[Displayed, ...]:
        """What the page displays: the traces of the plots, then the readouts."""
        rows = self._native.displayed()
        return tuple(
            Displayed(label, unit, kind, n if kind == "trace" else None, n if kind == "readout" else None)
            for label, unit, kind, n in rows
        )

    @property
    def readouts(self) -> dict[str, str]:
        """The readouts as the page prints them."""
        labels = [d.label for d in self.displayed if d.kind == "readout"]
        return dict(zip(labels, self._native.readout_texts(), strict=True))

    @property
    def values(self) -> dict[str, Value | None]:
        """The displayed values now, by label."""
        return dict(zip((d.label for d in self.displayed), self._native.values(), strict=True))

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings of opening the lab and of its run so far."""
        return tuple(Finding(**f) for f in self._native.findings())

    @property
    def model(self) -> Model:
        """A copy of the model with the changes of controls and programs."""
        return Model(self._native.model())

    def __getitem__(self, label: str) -> Value:
        return self._native.value(label)

    def __setitem__(self, label: str, value: Value) -> None:
        self._native.set(label, value)

    def press(self, label: str) -> None:
        """Presses a button."""
        self._native.press(label)

    def step(self, steps: int = 1) -> None:
        """Performs steps, whether or not the lab has reached its ``stopAt``."""
        self._native.step(steps)

    def play_to(self, time: float) -> int:
        """Plays until a time, s, or until the lab stops by itself. Returns the number of steps."""
        return self._native.play_to(time)

    def reset(self) -> None:
        """Resets like the button of the page: controls and model keep their values."""
        self._native.reset()

    def record(self, until: float | None = None, *, steps: int | None = None, every: int = 1) -> Recording:
        """Plays until a time, s, or for some steps, and records the displayed values every ``every`` steps."""
        if until is not None and steps is None:
            steps = max(0, round((until - self.time) / self.timestep))
        elif until is not None or steps is None:
            raise TypeError("a recording has either `until`, a time, or `steps`")
        _made, rows = self._native.record(steps, every)
        return Recording(rows[:, 0], rows[:, 1:], self.displayed)

    def field(self, name: str) -> Any:
        """A field of the data or of the model as the lab changed it: "qpos", "body_mass", "opt.gravity". A copy."""
        return self._native.field(name)

    def save(self) -> _labspec.LabState:
        """The state of the lab."""
        return self._native.save()

    def restore(self, state: _labspec.LabState) -> None:
        """Restores a state of this lab. It then continues with equal results, bit for bit."""
        self._native.restore(state)


def _opened(source: tuple[Any, ...]) -> Lab:
    """A lab as it was opened: its state is not part of it."""
    lab = Lab.__new__(Lab)
    lab._native = _labspec.Lab.from_json(*source) if len(source) == 2 else _labspec.Lab.from_lesson(*source)
    lab._source = source
    return lab


def _dictionary(source: tuple[Any, ...]) -> dict[str, Any]:
    text = source[0] if len(source) == 2 else _labspec.lab_json(*source[:3])
    lab: dict[str, Any] = json.loads(text)
    return lab
