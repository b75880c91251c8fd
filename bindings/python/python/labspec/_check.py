"""Checks of lessons: findings and claims."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _html, _labspec
from ._engine import Files
from ._json import loads, with_all_numbers

#: Called with what long work does now.
Progress = Callable[[str], object]


@dataclass(frozen=True)
class Finding:
    """What is wrong, where, why it matters and what to write instead."""

    code: str
    severity: str
    message: str
    why: str | None
    help: str | None
    file: str
    line: int | None
    column: int | None
    start: int
    end: int
    #: The owner of the claim that it is about, such as "quiz fall, question 2".
    owner: str | None = None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.line else ""
        return f"{place}{self.severity}[{self.code}]: {self.message}"


@dataclass(frozen=True)
class Claim:
    """An answer, a quoted number, a closed form or a lab, and what the check found about it."""

    owner: str
    subject: str
    state: str
    word: str
    part: str
    remark: str
    #: Bytes of the lesson.
    start: int
    end: int


@dataclass(frozen=True)
class Measured:
    """A measure, and its value at half the timestep."""

    value: float | None
    halved: float | None


@dataclass(frozen=True)
class Verification:
    """What a ``verify`` object was found to be: its runs, and its measures by "run.measure"."""

    #: The owner: "lab #1", "quiz fall, question 2".
    owner: str
    measures: Mapping[str, Measured]
    #: The runs by name, with the reason why one broke.
    runs: Mapping[str, str | None]
    #: The verdict on the answer, such as "verified".
    verdict: str | None
    #: The verdicts on the quoted numbers, by their texts.
    quotes: tuple[tuple[str, str], ...]

    def __getitem__(self, measure: str) -> float | None:
        """The value of a measure."""
        return self.measures[measure].value


@dataclass(frozen=True)
class Report:
    """The result of a check. It is true only if every claim was checked and is true."""

    outcome: str
    findings: tuple[Finding, ...]
    claims: tuple[Claim, ...]
    verifications: tuple[Verification, ...] = ()
    #: The lesson in the report of ``labspec check --format json``: its labs, and its claims with runs and measures.
    json: Mapping[str, Any] = field(default_factory=dict, repr=False)

    def __bool__(self) -> bool:
        return self.outcome == "clean"

    def __str__(self) -> str:
        return "\n".join([*map(str, self.findings), f"outcome: {self.outcome}"])

    def _repr_html_(self) -> str:
        claims = _html.table(["of", "claim", "result", "remark"], [[c.owner, f"{c.subject} {c.part}", c.word, c.remark] for c in self.claims])
        findings = _html.table(
            ["line", "finding", "message", "why", "help"],
            [["" if f.line is None else f.line, f"{f.severity}[{f.code}]", f.message, f.why or "", f.help or ""] for f in self.findings],
        )
        measures = _html.table(
            ["of", "measure", "value", "at half the timestep"],
            [[v.owner, name, *("" if x is None else x for x in (m.value, m.halved))] for v in self.verifications for name, m in v.measures.items()],
        )
        return _html.heading(f"outcome: {self.outcome}") + findings + claims + measures


def check(
    lesson: str | os.PathLike[str],
    *,
    text: str | None = None,
    models: Files = None,
    related: Mapping[str, str] | None = None,
    runs: bool = True,
    progress: Progress | None = None,
) -> Report:
    """Checks a lesson: runs its labs, and verifies its claims.

    ``lesson`` is the path of a Markdown or JSON file, which is read unless ``text`` is given. ``models`` is a folder of models, or MJCF by
    name; by default the folder ``models`` beside or above the lesson. ``related`` are the texts of other lessons that this one names, by path. Without
    ``runs`` only its structure, models and names are checked: what was left out is not clean. Ctrl-C ends it.
    """
    path = Path(lesson)
    if text is None:
        text = path.read_text(encoding="utf-8")
        models = models if models is not None else models_near(path)
    return checked(os.fspath(path), text, models, related, "full" if runs else "static", progress)


def checked(
    path: str, text: str, models: Files, related: Mapping[str, str] | None, level: str, progress: Progress | None
) -> Report:
    """The report of a check with this level."""
    outcome, findings, claims, lesson = _labspec.check(
        path, text, models, None if related is None else dict(related), level, progress
    )
    raw = loads(lesson)
    verifications = tuple(_verification(claim) for claim in with_all_numbers(raw["claims"]))
    return Report(outcome, tuple(Finding(**f) for f in findings), tuple(Claim(**c) for c in claims), verifications, raw)


def _verification(claim: dict[str, Any]) -> Verification:
    return Verification(
        owner=claim["name"],
        measures={name: Measured(**measure) for name, measure in claim["measures"].items()},
        runs={run["name"]: run["broke"] for run in claim["runs"]},
        verdict=claim["answer"] and claim["answer"]["verdict"],
        quotes=tuple((quote["text"], quote["verdict"]) for quote in claim["quotes"]),
    )


def models_near(path: Path) -> Path | None:
    """The folder ``models`` beside or above a lesson."""
    for folder in path.resolve().parents:
        if (folder / "models").is_dir():
            return folder / "models"
    return None
