"""Checks of lessons: findings and claims."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from . import _labspec
from ._engine import Files


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
class Report:
    """The result of a check. It is true only if every claim was checked and is true."""

    outcome: str
    findings: tuple[Finding, ...]
    claims: tuple[Claim, ...]

    def __bool__(self) -> bool:
        return self.outcome == "clean"

    def __str__(self) -> str:
        return "\n".join([*map(str, self.findings), f"outcome: {self.outcome}"])


def check(
    lesson: str | os.PathLike[str],
    *,
    text: str | None = None,
    models: Files = None,
    related: Mapping[str, str] | None = None,
    runs: bool = True,
) -> Report:
    """Checks a lesson: runs its labs, and verifies its claims.

    ``lesson`` is the path of a Markdown or JSON file, which is read unless ``text`` is given. ``models`` is a folder of models, or MJCF by
    name; by default the folder ``models`` beside or above the lesson. ``related`` are the texts of other lessons that this one names, by path. Without
    ``runs`` only its structure, models and names are checked: what was left out is not clean.
    """
    path = Path(lesson)
    if text is None:
        text = path.read_text(encoding="utf-8")
        models = models if models is not None else models_near(path)
    outcome, findings, claims = _labspec.check(os.fspath(path), text, models, None if related is None else dict(related), runs)
    return Report(outcome, tuple(Finding(**f) for f in findings), tuple(Claim(**c) for c in claims))


def models_near(path: Path) -> Path | None:
    """The folder ``models`` beside or above a lesson."""
    for folder in path.resolve().parents:
        if (folder / "models").is_dir():
            return folder / "models"
    return None
