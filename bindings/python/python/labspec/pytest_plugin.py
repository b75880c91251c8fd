"""Lessons as tests: ``pytest --labspec`` collects ``lesson.md::lab[#1]``, ``lesson.md::quiz[fall]::2`` and ``lesson.md::text``.

A test fails if a claim of its lab, question or comment is false or could not be checked, or if it has an error or a warning. A question without
a claim is skipped, and so is what was not checked: nothing was verified. ``text`` has all findings that belong to no other test, so that the tests
of a lesson pass only if ``labspec check`` reports nothing but notes. A lesson is checked once, when its first test runs.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ._check import Claim, Finding, Report, check

_LAB = re.compile(r'lab (#\S+)(?: "(.*)")?$', re.DOTALL)
_QUESTION = re.compile(r"quiz (.*), question (\d+)$", re.DOTALL)
_FAILED = ("false", "unchecked")
_PROBLEMS = ("error", "warning")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds ``--labspec``."""
    group = parser.getgroup("labspec")
    group.addoption("--labspec", action="store_true", help="collect lessons with labs and quizzes (.md) as tests")
    group.addoption("--labspec-models", metavar="FOLDER", help="the models of the labs [default: `models` beside or above a lesson]")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collects a Markdown file with labs or quizzes."""
    if not parent.config.getoption("--labspec") or file_path.suffix != ".md":
        return None
    return LessonFile.from_parent(parent, path=file_path)


class LessonFile(pytest.File):
    """A lesson."""

    _report: Report | None = None

    def check(self, *, runs: bool) -> Report:
        """Checks the lesson."""
        return check(self.path, models=self.config.getoption("--labspec-models"), runs=runs)

    @property
    def report(self) -> Report:
        """The report of the whole check, made once."""
        if self._report is None:
            self._report = self.check(runs=True)
        return self._report

    def collect(self) -> Iterator[pytest.Item | pytest.Collector]:
        """Yields a test for each lab, a group for each quiz, and one for the rest of the text."""
        found = self.check(runs=False)
        owners = dict.fromkeys(c.owner for c in found.claims if c.subject != "file")
        quizzes: dict[str, list[tuple[str, str]]] = {}
        others = []
        for owner in owners:
            if lab := _LAB.match(owner):
                yield ClaimItem.from_parent(self, name=f"lab[{lab[2] or lab[1]}]", owners=(owner,))
            elif question := _QUESTION.match(owner):
                quizzes.setdefault(question[1], []).append((question[2], owner))
            else:
                others.append(owner)
        for quiz, questions in quizzes.items():
            yield QuizGroup.from_parent(self, name=f"quiz[{quiz}]", questions=questions)
        if owners or found.findings:
            yield ClaimItem.from_parent(self, name="text", owners=tuple(others), elsewhere=tuple(o for o in owners if o not in others))


class QuizGroup(pytest.Collector):
    """A quiz."""

    def __init__(self, *, questions: list[tuple[str, str]], **more: Any) -> None:
        super().__init__(**more)
        self._questions = questions

    def collect(self) -> Iterator[pytest.Item]:
        """Yields a test for each question."""
        for number, owner in self._questions:
            yield ClaimItem.from_parent(self, name=number, owners=(owner,))


class ClaimFailure(Exception):
    """A claim that is false or was not checked, or an error in a lab."""


class ClaimItem(pytest.Item):
    """The claims of a lab, a question or the text."""

    def __init__(self, *, owners: tuple[str, ...], elsewhere: tuple[str, ...] | None = None, **more: Any) -> None:
        super().__init__(**more)
        self._owners = owners
        #: The owners of the other tests of the lesson, if this one has all that belongs to none of them.
        self._elsewhere = elsewhere

    def _lesson(self) -> LessonFile:
        lesson = self.getparent(LessonFile)
        assert lesson is not None
        return lesson

    def runtest(self) -> None:
        """Checks the lesson, if that has not been done, and looks at these claims."""
        report = self._lesson().report
        claims = [c for c in report.claims if c.owner in self._owners]
        failed = [c for c in claims if c.state in _FAILED]
        problems = [f for f in report.findings if f.severity in _PROBLEMS]
        if self._elsewhere is None:
            problems = [f for f in problems if _is_about(f, self._owners, claims)]
        else:
            of_others = [c for c in report.claims if c.owner in self._elsewhere]
            problems = [f for f in problems if not _is_about(f, self._elsewhere, of_others)]
        if failed or problems:
            raise ClaimFailure(_evidence(failed, problems))
        left = [c for c in claims if c.state == "left out"]
        if left:
            pytest.skip(f"not checked: {', '.join(c.owner for c in left)}")
        if self._elsewhere is not None and not claims:
            return
        decided = [c for c in claims if c.state == "true"]
        if not decided:
            pytest.skip("it has no claim, so nothing was verified")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The evidence, without a traceback."""
        if isinstance(excinfo.value, ClaimFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """The place in the lesson."""
        return self.path, None, self.nodeid.partition("::")[2]


def _is_about(finding: Finding, owners: tuple[str, ...], claims: list[Claim]) -> bool:
    if finding.owner is not None:
        return finding.owner in owners
    return any(c.start <= finding.start and finding.end <= c.end for c in claims)


def _evidence(failed: list[Claim], errors: list[Finding]) -> str:
    lines = [f"{c.subject} {c.part} {c.word}: {c.remark}".replace("  ", " ") for c in failed]
    for finding in errors:
        lines.append(str(finding))
        lines += [f"  why: {finding.why}"] * bool(finding.why) + [f"  help: {finding.help}"] * bool(finding.help)
    return "\n".join(lines)
