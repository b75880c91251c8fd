"""Labs: what a student can do on a page, and what the page displays."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from . import _html, _labspec
from ._check import Finding, Progress, Report, checked, models_near
from ._engine import Files, Model
from ._measure import measure_runs
from ._recording import Displayed, Recording, Run, Value
from ._reports import Precision, Stability, precision_of, stability_of

#: Steps of a run that is drawn for a notebook.
_MOST_DRAWN = 50_000


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
        return Recording(rows[:, 0], rows[:, 1:], self.displayed, self)

    def run(
        self,
        params: Mapping[str, Value] | None = None,
        measures: Mapping[str, str] | None = None,
        *,
        until: float | None = None,
        every: int | None = None,
    ) -> Run:
        """Runs the lab from its start with these values of its controls, and measures the run, like one point of :func:`labspec.sweep`.

        The run is independent of what was done to this lab, and changes nothing of it. It ends at ``until``, s, or as the lab does. It is recorded
        every ``every`` steps; by default only if there are no ``measures``. ``lab.run`` can be pickled, so that it can be sent to other processes:
        ``executor.map(lab.run, points, itertools.repeat(measures))``. A run that cannot be made has an ``error``, and NaN as measures.
        """
        values, asked = dict(params or {}), dict(measures or {})
        error: str | None = None
        found = dict.fromkeys(asked, float("nan"))
        if asked:
            [(numbers, error)] = measure_runs((self.json, self._source[-1], asked, until), [values])
            found = dict(zip(asked, numbers, strict=True)) if error is None else found
        recording = None
        if error is None and (every is not None or not asked):
            try:
                recording = self._record_run(values, until, 1 if every is None else every)
            except _labspec.LabspecError as e:
                error = str(e)
        return Run(values, found, error, recording)

    def _record_run(self, params: Mapping[str, Value], until: float | None, every: int) -> Recording:
        """The samples of a run from the start."""
        given = {"until": until, "set": list(params.items()), "press": []}
        rows = _labspec.record_run(self._labelled(), self._source[-1], given, every)
        # Another thread may use this lab.
        lab = _opened(self._source)
        return Recording(rows[:, 0], rows[:, 1:], lab.displayed, lab)

    def verify(self, claims: Mapping[str, Any] | None = None, *, progress: Progress | None = None) -> Report:
        """Verifies the claims of the lab, or those of another ``verify`` object about it: runs, measures, conditions and quotes.

        The runs start from the lab as it was opened. The report is that of ``labspec verify``; its numbers are in ``verifications``.
        """
        if claims is not None:
            text, path = json.dumps({**self.json, "verify": claims}), "lab.json"
            return checked(path, text, self._source[-1], None, "claims", progress)
        path, text, address = self._text()
        report = checked(path, text, self._source[-1], None, "claims", progress)
        return _about(report, address)

    def precision(
        self,
        *,
        until: float | None = None,
        set: Mapping[str, Value] | None = None,
        press: Iterable[tuple[str, float]] = (),
        integrators: Iterable[str] = (),
        vary: Iterable[str] = (),
        progress: Progress | None = None,
    ) -> Precision:
        """Compares error and run time of integrators and timesteps, like ``labspec precision``.

        The runs start from the lab as it was opened, with the controls ``set``, and with buttons pressed at their times, s. ``vary`` are settings of the
        constraint solver: "iterations", "tolerance", "cone". ``progress`` is called with what is done now. Ctrl-C ends it.
        """
        given = {"until": until, "set": list((set or {}).items()), "press": list(press)}
        return precision_of(*_labspec.precision(self._labelled(), self._source[-1], given, list(integrators), list(vary), progress))

    def stability(
        self,
        *,
        until: float | None = None,
        margins: bool = False,
        map: tuple[str, str] | None = None,
        set: Mapping[str, Value] | None = None,
        press: Iterable[tuple[str, float]] = (),
        progress: Progress | None = None,
    ) -> Stability:
        """Finds what breaks when a student moves the controls in every way, like ``labspec stability``.

        With ``margins``, also how far the timestep, gains, stiffnesses and mass ratios can be raised; with ``map``, what happens over a grid of two
        controls. Ctrl-C ends it.
        """
        given = {"until": until, "set": list((set or {}).items()), "press": list(press)}
        return stability_of(*_labspec.stability(self._labelled(), self._source[-1], given, margins, map, progress))

    def _text(self) -> tuple[str, str, str | None]:
        """The text that has the lab, its name, and the address of the lab in it."""
        if len(self._source) == 2:
            return "lab.json", self._source[0], None
        path, text, address, _models = self._source
        return path, text, address

    def _labelled(self) -> dict[str, Any]:
        return dict(zip(("path", "text", "address"), self._text(), strict=True))

    def _repr_html_(self) -> str:
        title, kind = self._native.title()
        controls = [[c.label, "" if c.kind == "button" else self[c.label], c.unit] for c in self.controls]
        state = self.save()
        try:
            self.reset()
            pictures = "".join(_html.picture(svg, f"plot {i}") for i, svg in enumerate(self.record(steps=self._watched()).plots(), 1))
        except _labspec.LabspecError as e:
            pictures = f"<p>{_html.text(e)}</p>"
        finally:
            self.restore(state)
        return (
            _html.heading(title or kind, f"t = {self.time:g} s")
            + pictures
            + _html.table(["control", "value", "unit"], controls)
            + _html.table(["readout", f"at {self.time:g} s"], list(self.readouts.items()))
        )

    def _watched(self) -> int:
        """The steps that a student watches: until ``stopAt``, or in the longest window of a plot."""
        source = self.json
        plots = source.get("plots")
        windows = [_seconds(plot.get("window", 5)) for plot in plots if isinstance(plot, dict)] if isinstance(plots, list) else []
        seconds = _seconds(source.get("stopAt")) or max(windows, default=0.0)
        return round(min(_MOST_DRAWN, seconds / self.timestep))

    def field(self, name: str) -> Any:
        """A field of the data or of the model as the lab changed it: "qpos", "body_mass", "opt.gravity". A copy."""
        return self._native.field(name)

    def save(self) -> _labspec.LabState:
        """The state of the lab."""
        return self._native.save()

    def restore(self, state: _labspec.LabState) -> None:
        """Restores a state of this lab. It then continues with equal results, bit for bit."""
        self._native.restore(state)


def _seconds(value: object) -> float:
    """A time in a lab that anybody may have written; 0 if it is none."""
    try:
        seconds = float(value) if isinstance(value, (int, float)) else 0.0
    except OverflowError:
        return float("inf")
    return seconds if seconds > 0 else 0.0


def is_owned(owner: str | None, address: str | None) -> bool:
    """Whether an owner of claims is the lab at an address of a lesson, or the question that has it."""
    if owner is None or address is None:
        return address is None
    quiz, _, number = address.removeprefix("#").rpartition(".")
    name = f"quiz {quiz}, question {number}" if quiz else f"lab {address}"
    return owner == name or owner.startswith(f"{name} ")


def _about(report: Report, address: str | None) -> Report:
    """The part of a report about one lab of a lesson, or about the question that has it."""
    if address is None:
        return report
    claims = tuple(c for c in report.claims if is_owned(c.owner, address))

    def concerns(f: Finding) -> bool:
        return is_owned(f.owner, address) if f.owner is not None else any(c.start <= f.start and f.end <= c.end for c in claims)

    findings = tuple(f for f in report.findings if concerns(f))
    verifications = tuple(v for v in report.verifications if is_owned(v.owner, address))
    # The runs of the lab as a student plays it are left out: this is about claims.
    states = {c.state for c in claims if c.subject != "lab"}
    if "false" in states or any(f.severity in ("error", "warning") for f in findings):
        outcome = "findings"
    elif not states & {"true"}:
        outcome = "nothing"
    else:
        outcome = "partial" if states & {"unchecked", "left out"} else "clean"
    return replace(report, outcome=outcome, claims=claims, findings=findings, verifications=verifications)


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
