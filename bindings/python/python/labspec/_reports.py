"""Numerics for authors: the reports of ``labspec precision`` and ``labspec stability``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from . import _html
from ._json import loads, with_all_numbers


@dataclass(frozen=True)
class PrecisionRow:
    """A run with an integrator and a timestep, compared with the truth. Tuples are in the order of :attr:`Precision.traces`."""

    integrator: str
    #: s
    timestep: float
    #: A setting of the constraint solver that was varied.
    solver: str | None
    #: Whether it is the setting of the lab.
    own: bool
    #: "good", or how the run failed.
    fate: str
    #: The largest errors, in the units of the traces; NaN where there is none.
    errors: tuple[float | None, ...]
    orders: tuple[float | None, ...]
    #: The cost of the whole run as the engine counts it: the same on every machine.
    work: float
    #: The time of a run on this machine, µs per simulated second.
    microseconds_per_second: float


@dataclass(frozen=True)
class Precision:
    """The error and the cost of integrators and timesteps for a lab."""

    traces: tuple[str, ...]
    units: tuple[str | None, ...]
    #: The reference in words; ``None`` if no method completes the lab.
    reference: str | None
    #: The simulated time, s.
    length: float
    rows: tuple[PrecisionRow, ...]
    #: The rows than which none is both closer and cheaper.
    front: tuple[PrecisionRow, ...]
    #: Advice in sentences.
    advice: tuple[str, ...]
    #: The report of ``labspec precision --format json``.
    json: Mapping[str, Any] = field(repr=False)
    #: The chart of cost and error, as SVG.
    chart: str | None = field(default=None, repr=False)

    @property
    def own(self) -> PrecisionRow | None:
        """The row with the setting of the lab."""
        return next((row for row in self.rows if row.own), None)

    def _repr_html_(self) -> str:
        heads = ["integrator", "step (ms)", "work", *(f"error of {trace}" for trace in self.traces)]
        rows = [
            [f"{r.integrator}{' *' if r.own else ''}", 1000 * r.timestep, r.work, *(r.errors if r.fate == "good" else [r.fate] * len(self.traces))]
            for r in self.rows
        ]
        chart = _html.picture(self.chart, "cost and error") if self.chart else ""
        advice = "".join(f"<p>{_html.text(one)}</p>" for one in self.advice)
        return _html.heading("Precision", self.reference or "no method completes this lab") + _html.table(heads, rows) + chart + advice


def precision_of(text: str, chart: str | None) -> Precision:
    """The comparison in a report."""
    raw = loads(text)
    report = with_all_numbers(raw)
    rows = tuple(
        PrecisionRow(
            integrator=row["integrator"],
            timestep=row["timestep"],
            solver=row["solver"],
            own=row["own"],
            fate=row["fate"],
            errors=tuple(row["errors"]),
            orders=tuple(row["orders"]),
            work=row["work"],
            microseconds_per_second=row["microsecondsPerSecond"],
        )
        for row in report["rows"]
    )
    return Precision(
        traces=tuple(report["traces"]),
        units=tuple(report["units"]),
        reference=report["reference"],
        length=report["length"],
        rows=rows,
        front=tuple(rows[i] for i in report["front"]),
        advice=tuple(advice["text"] for advice in report["advice"]),
        json=raw,
        chart=chart,
    )


@dataclass(frozen=True)
class Fault:
    """What goes wrong when a student moves the controls."""

    #: "diverges", "energyGrows", "tunnelling", …
    kind: str
    #: s
    time: float
    subject: str
    cause: str
    #: The controls that were moved: label, time in s, and value; ``None`` for a button.
    setting: tuple[tuple[str, float, float | str | bool | None], ...]
    #: The number of settings that show it.
    settings: int
    #: Whether the lab declares it.
    expected: bool
    #: What helps.
    remedies: tuple[str, ...]


@dataclass(frozen=True)
class Margin:
    """How far a parameter can be raised before something goes wrong, in its unit."""

    parameter: str
    subject: str
    unit: str
    now: float
    largest: float | None
    breaks: float | None
    #: What the theory says.
    bound: float | None


@dataclass(frozen=True)
class Stability:
    """What breaks in a lab. It is true if nothing does."""

    fine: bool
    #: The length of each run, s.
    length: float
    runs: int
    faults: tuple[Fault, ...]
    margins: tuple[Margin, ...]
    #: What was not tried.
    left_out: tuple[str, ...]
    #: The report of ``labspec stability --format json``.
    json: Mapping[str, Any] = field(repr=False)
    #: The map of two controls, as SVG.
    chart: str | None = field(default=None, repr=False)

    def __bool__(self) -> bool:
        return self.fine

    def _repr_html_(self) -> str:
        heading = _html.heading("Nothing goes wrong" if not self.faults else f"{len(self.faults)} faults", f"{self.runs} runs of {self.length:g} s")
        faults = _html.table(
            ["fault", "at (s)", "of", "cause", "helps"],
            [[f.kind + (" (as the lab expects)" if f.expected else ""), f.time, f.subject, f.cause, "; ".join(f.remedies)] for f in self.faults],
        )
        margins = _html.table(
            ["parameter", "of", "now", "largest", "theory"],
            [[m.parameter, m.subject, m.now, "none" if m.largest is None else m.largest, "" if m.bound is None else m.bound] for m in self.margins],
        )
        return heading + faults + margins + (_html.picture(self.chart, "map of two controls") if self.chart else "")


def stability_of(text: str, chart: str | None) -> Stability:
    """The results in a report."""
    raw = loads(text)
    report = with_all_numbers(raw)
    faults = tuple(
        Fault(
            kind=row["kind"],
            time=row["time"],
            subject=row["subject"],
            cause=row["cause"],
            setting=tuple((action["control"], action["time"], action["value"]) for action in row["setting"]),
            settings=row["settings"],
            expected=row["expected"],
            remedies=tuple(remedy["change"] for remedy in row["remedies"]),
        )
        for row in report["findings"]
    )
    margins = tuple(Margin(**{key: row[key] for key in ("parameter", "subject", "unit", "now", "largest", "breaks", "bound")}) for row in report["margins"])
    return Stability(
        fine=report["fine"],
        length=report["length"],
        runs=len(report["runs"]),
        faults=faults,
        margins=margins,
        left_out=tuple(report["leftOut"]),
        json=raw,
        chart=chart,
    )
