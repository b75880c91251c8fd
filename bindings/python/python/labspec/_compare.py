"""Whether a number, or a verdict, depends on the engine: the same runs and measures in labspec and in MuJoCo."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _html, _labspec
from ._check import Finding, Progress, Report, checked, models_near
from ._engine import Files
from ._lab import Lab, is_owned
from ._labspec import LabspecError
from ._mujoco import MujocoLab, the_package
from ._recording import Value


@dataclass(frozen=True)
class EngineRow:
    """A measure of a run in both engines."""

    #: The owner of the claim: "lab #1", "quiz fall, question 2".
    owner: str
    #: "run.measure"; "measure" of a claim with one run.
    measure: str
    labspec: float | None
    #: The other engine's value.
    other: float | None
    #: Whether it depends on the engine: the values differ by more than a start that differs by 1e-14, or a better solution of the constraints, explains.
    depends: bool
    #: Why it was not compared.
    reason: str = ""


@dataclass(frozen=True)
class EngineComparison:
    """Measures and verdicts in both engines. It is true if every measure was compared, and neither depends on the engine."""

    #: "MuJoCo 3.14.0"
    engine: str
    rows: tuple[EngineRow, ...]
    #: The number of answers and quoted numbers that were decided again, with the numbers of the other engine.
    verdicts: int
    #: Verdicts that depend on the engine: `engine-dependent`.
    findings: tuple[Finding, ...]
    #: Fields that programs read, but that the other engine does not have: those of labspec were used.
    missing: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.rows) and not self.findings and not any(row.depends or row.reason for row in self.rows)

    def __getitem__(self, measure: str) -> EngineRow:
        """The row of a measure, of the first claim that has it."""
        return next(row for row in self.rows if row.measure == measure)

    def _cells(self) -> list[tuple[str, str, str, str, str]]:
        def value(x: float | None) -> str:
            return "–" if x is None else f"{x:.9g}"

        return [(r.owner, r.measure, value(r.labspec), value(r.other), r.reason or ("yes" if r.depends else "no")) for r in self.rows]

    def _heads(self) -> tuple[str, str, str, str, str]:
        return ("of", "measure", "labspec", self.engine, "depends on the engine")

    def __str__(self) -> str:
        table = [self._heads(), *self._cells()]
        widths = [max(len(row[k]) for row in table) for k in range(5)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table]
        depending = len(self.findings)
        return "\n".join([*lines, *map(str, self.findings), f"{depending} of {self.verdicts} verdicts depend on the engine"])

    def _repr_html_(self) -> str:
        findings = _html.table(["line", "finding", "why"], [["" if f.line is None else f.line, f.message, f.why or ""] for f in self.findings])
        heading = _html.heading(f"Comparison with {self.engine}", f"{len(self.findings)} of {self.verdicts} verdicts depend on the engine")
        return heading + findings + _html.table(self._heads(), self._cells())


def compare_engines(
    lab: Lab | str | os.PathLike[str],
    measures: Mapping[str, str] | None = None,
    *,
    until: float | None = None,
    set: Mapping[str, Value] | None = None,
    press: Iterable[tuple[str, float]] = (),
    models: Files = None,
    progress: Progress | None = None,
) -> EngineComparison:
    """Makes the same runs in labspec and in MuJoCo (the package ``mujoco``, of any version), and compares their measures and verdicts.

    With ``measures``, such as ``{"lands": "first(contact('ball', 'floor'))"}``, one run of the lab is made, from the lab as it was opened until ``until``, s, or until
    it ends. Without them, the runs are those of the claims of the lab, or of a whole lesson if its path is given. Searches, ranges and closed forms
    rest on further runs, which are not made.
    """
    if not isinstance(lab, Lab):
        path = Path(lab)
        source = (os.fspath(path), path.read_text(encoding="utf-8"), models if models is not None else models_near(path))
        return _compared(*source, lambda _owner: True, progress)
    path_of, text, address = lab._text()
    if measures is None:
        if until is not None or set or press:
            raise ValueError("the runs of claims have their own lengths and controls")
        return _compared(path_of, text, lab._source[-1], lambda owner: is_owned(owner, address), progress)
    end = {} if until is None else {"until": until}
    run = {"set": dict(set or {}), "press": [list(one) for one in press], **end}
    text = json.dumps({**lab.json, "verify": {"runs": {"run": run}, "measure": dict(measures)}})
    return _compared("lab.json", text, lab._source[-1], lambda _owner: True, progress)


def _compared(path: str, text: str, models: Files, is_wanted: Callable[[str], bool], progress: Progress | None) -> EngineComparison:
    engine = f"MuJoCo {the_package().__version__}"
    report = checked(path, text, models, None, "claims", progress)
    requests = [one for one in _labspec.claimed_runs(path, text, models) if is_wanted(one[0])]
    _refuse_errors(report, requests, is_wanted)
    results: dict[str, dict[str, Any]] = {}
    reasons: dict[tuple[str, str], str] = {}
    missing: dict[str, None] = {}
    for owner, run, key, task, refused in requests:
        if progress is not None:
            progress(f"{engine}: {owner}, {run}")
        if task is None:
            reasons[owner, run] = refused or "another engine cannot make this run"
        elif key not in results:
            try:
                results[key] = _results(json.loads(task), models, missing)
            except (LabspecError, NotImplementedError) as e:
                reasons[owner, run] = str(e)
    claims, findings = _labspec.cross_check(path, text, engine, results, models)
    wanted = [claim for claim in claims if is_wanted(claim["owner"])]
    rows = tuple(row for claim in wanted for row in _rows(claim, report, requests, results, reasons))
    spans = [(c.start, c.end) for c in report.claims if is_wanted(c.owner)]
    about = tuple(Finding(**f) for f in findings if f["code"] == "engine-dependent" and any(a <= f["start"] and f["end"] <= b for a, b in spans))
    return EngineComparison(engine, rows, sum(claim["verdicts"] for claim in wanted), about, tuple(missing))


def _refuse_errors(report: Report, requests: list[Any], is_wanted: Callable[[str], bool]) -> None:
    """An error if there is nothing to compare, or a measure that has no meaning."""
    wrong = [f for f in report.findings if f.severity == "error" and (f.owner is None or is_wanted(f.owner))]
    if requests and not (wrong and all(task is None for _owner, _run, _key, task, _refused in requests)):
        return
    error = LabspecError(f"nothing can be compared: {wrong[0].message if wrong else 'there is no claim with a run'}")
    error.code, error.findings = (wrong[0].code if wrong else "call"), [vars(f) for f in wrong]
    raise error


def _rows(claim: Mapping[str, Any], report: Report, requests: list[Any], results: Mapping[str, Any], reasons: Mapping[Any, str]) -> Iterable[EngineRow]:
    """The measures of a claim: our values, the others, and those that differ."""
    owner = claim["owner"]
    runs = [(run, key) for of, run, key, _task, _refused in requests if of == owner]

    def short(name: str) -> str:
        """The measure of the only run has its name alone."""
        return name.removeprefix(f"{runs[0][0]}.") if len(runs) == 1 else name

    ours = {short(name): one.value for v in report.verifications if v.owner == owner for name, one in v.measures.items()}
    differing = {short(name): (here, there) for name, here, there in claim["differing"]}
    unjudged = {short(name): reason for name, reason in claim["unjudged"]}
    theirs: dict[str, float] = {}
    for run, key in runs:
        for name, value in results.get(key, {"values": {}})["values"].items():
            theirs[f"{run}.{name}"] = value
            theirs.setdefault(name, value)
    for name in dict.fromkeys([*ours, *differing, *unjudged]):
        here, there = differing.get(name, (ours.get(name), theirs.get(name)))
        run = runs[0][0] if len(runs) == 1 else name.rpartition(".")[0]
        reason = unjudged.get(name) or reasons.get((owner, run)) or ("" if there is not None else "its run was not made")
        yield EngineRow(owner, name, here, there, name in differing and not reason, reason)


def _results(task: dict[str, Any], models: Files, missing: dict[str, None]) -> dict[str, Any]:
    """The results of a run in MuJoCo."""
    there = MujocoLab(Lab(_lab_of(task), models))
    missing.update(dict.fromkeys(there.missing))
    if task["timestep"] is not None:
        there.model.opt.timestep = task["timestep"]
    for label, value in task["set"]:
        there[label] = value
    if task["setup"]:
        there.run_statements(task["setup"])
    timestep = float(there.model.opt.timestep)
    steps = int(task["steps"]) if task["steps"] is not None else math.floor(task["until"] / timestep + 0.5)
    texts = dict(task["measures"]) | {text: text for text in task["expressions"]}
    refused = {}
    for name, text in texts.items():
        try:
            there.compiles(text)
        except (LabspecError, NotImplementedError) as e:
            refused[name] = str(e)
    measured = {name: text for name, text in texts.items() if name not in refused}
    press = [(label, time) for label, time in task["press"]]
    values = there.measure(measured, steps=steps, press=press, stop=task["stop"], stop_at=task["stopAt"])
    missing.update(dict.fromkeys(there.missing))
    return {"values": values, "refused": refused, "warnings": there.warnings, "broke": there.broke}


def _lab_of(task: dict[str, Any]) -> dict[str, Any]:
    """The lab of a task: its programs, and what it displays, on the model of the task."""
    lab = task["lab"]
    given: dict[str, list[Any]] = {}
    for label, value in task["set"]:
        given.setdefault(label, []).append(value)
    readouts: list[dict[str, Any]] = []
    plots: dict[int, list[dict[str, Any]]] = {}
    for name, expr, digits in lab["shown"]:
        kind, _, rest = name.partition("/")
        number, _, label = rest.partition("/")
        if digits is not None and kind != "readout":
            readouts.append({"label": name, "expr": expr, "digits": digits})
        elif digits is None and kind == "plot" and number.isdigit():
            plots.setdefault(int(number), []).append({"label": label, "expr": expr})
    made: dict[str, Any] = {"xml": task["xml"], "controls": [_control_of(c, given) for c in lab["controls"]], "readouts": readouts}
    made["plots"] = [{"traces": plots.get(i, [])} for i in range(max(plots, default=-1) + 1)]
    return made | {key: lab[key] for key in ("key", "setup", "controller") if lab[key] is not None}


def _control_of(control: dict[str, Any], given: Mapping[str, list[Any]]) -> dict[str, Any]:
    """A control as a select with the values that a run gives it, so that each of them can be chosen."""
    if "run" in control:
        return {"type": "button", **control}
    values = [control["value"], *given.get(control["label"], [])]
    return {"type": "select", "options": [[f"option {i}", value] for i, value in enumerate(values)], **{k: v for k, v in control.items() if v is not None}}
