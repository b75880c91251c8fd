"""Lessons as tests: ``pytest --labspec`` collects ``lesson.md::lab[#1]``, ``lesson.md::quiz[fall]::2`` and ``lesson.md::text``.

A test fails if a claim of its lab, question or comment is false or could not be checked, or if it has an error or a warning. A question without
a claim is skipped, and so is what was not checked: nothing was verified. ``text`` has all findings that belong to no other test, so that the tests
of a lesson pass only if ``labspec check`` reports nothing but notes. A lesson is checked once, when its first test runs.

``pytest --labspec-listings``, or ``labspec_listings = true`` in the settings of pytest, collects ``lesson.md::listing[3]``: the third Python listing
that has an output below it. ``labspec check --listings`` runs the listings of a lesson, once, when its first test of a listing runs. Such a test passes
only if its listing was run and prints the displayed output; it is never skipped. Listings are programs: run only those that you trust with your files.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import pytest
from _pytest.junitxml import xml_key

from . import _labspec
from ._check import Claim, Finding, Report, check

_LAB = re.compile(r'lab (#\S+)(?: "(.*)")?$', re.DOTALL)
_QUESTION = re.compile(r"quiz (.*), question (\d+)$", re.DOTALL)
#: The id of the test of a question: file, quiz, number.
_TEST_OF_QUESTION = re.compile(r"(.+\.md)::(quiz\[.*\])::(\d+)$", re.DOTALL)
_FAILED = ("false", "unchecked")
_PROBLEMS = ("error", "warning")
_Row = TypeVar("_Row", Claim, Finding)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds ``--labspec`` and ``--labspec-listings``."""
    group = parser.getgroup("labspec")
    group.addoption("--labspec", action="store_true", help="collect lessons with labs and quizzes (.md) as tests")
    group.addoption("--labspec-models", metavar="FOLDER", help="the models of the labs [default: `models` beside or above a lesson]")
    about = "run the Python listings of lessons (.md) that have an output below them, and compare the output; run only those that you trust with your files"
    group.addoption("--labspec-listings", action="store_true", help=about)
    kind: Literal["bool"] = "bool"
    parser.addini("labspec_listings", about, type=kind, default=False)


def pytest_configure(config: pytest.Config) -> None:
    """Names the tests of questions in reports."""
    config.pluginmanager.register(_QuestionNames(config), "labspec-names")


class _QuestionNames:
    """The names of questions in reports. pytest 9.2 reads ``quiz[fall]::2`` as a parameter ``fall]::2``, and would display ``quiz[fall]::2]``."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> Iterator[None]:
        """Names the test in the report of JUnit before it is written there, and in the summary after all others have read its id."""
        found = _TEST_OF_QUESTION.match(report.nodeid)
        xml = self._config.stash.get(xml_key, None)
        if found and xml is not None:
            reporter: Any = xml.node_reporter(report)
            owners = [*([xml.prefix] if xml.prefix else []), found[1].replace("/", "."), found[2]]
            reporter.add_attribute("classname", ".".join(owners))
            reporter.add_attribute("name", found[3])
        result = yield
        identifier: Any = getattr(report, "_id", None)
        if found and identifier is not None:
            report._id = replace(identifier, names=(found[2], found[3]), params=None)
        return result


def _collects_listings(config: pytest.Config) -> bool:
    return bool(config.getoption("--labspec-listings") or config.getini("labspec_listings"))


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collects a Markdown file with labs, quizzes or listings."""
    if file_path.suffix != ".md" or not (parent.config.getoption("--labspec") or _collects_listings(parent.config)):
        return None
    return LessonFile.from_parent(parent, path=file_path)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Keeps one test of a question that was selected twice, with its lesson and by its own name."""
    seen: set[str] = set()
    kept = []
    for item in items:
        if not isinstance(item, ClaimItem) or item.nodeid not in seen:
            kept.append(item)
        seen.add(item.nodeid)
    items[:] = kept


class LessonFile(pytest.File):
    """A lesson."""

    _report: Report | None = None
    _listing_report: dict[str, Any] | str | None = None

    def check(self, *, runs: bool) -> Report:
        """Checks the lesson."""
        return check(self.path, models=self.config.getoption("--labspec-models"), runs=runs)

    @property
    def report(self) -> Report:
        """The report of the whole check, made once."""
        if self._report is None:
            self._report = self.check(runs=True)
        return self._report

    @property
    def listing_report(self) -> dict[str, Any] | str:
        """The report of ``labspec check --listings``, made once, or the message of a check that failed."""
        if self._listing_report is None:
            self._listing_report = self._run_listings()
        return self._listing_report

    def _run_listings(self) -> dict[str, Any] | str:
        models = self.config.getoption("--labspec-models")
        command = [sys.executable, "-P", "-m", "labspec", "check", str(self.path), "--listings", "--format", "json"]
        command += ["--models", str(models)] if models else []
        result = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        try:
            report = json.loads(result.stdout)
            if result.returncode in (0, 1) and isinstance(report, dict):
                return report
        except ValueError:
            pass
        message = result.stderr.decode("utf-8", "replace").strip()
        return f"`labspec check --listings` failed with exit code {result.returncode}: {message}"

    def collect(self) -> Iterator[pytest.Item | pytest.Collector]:
        """Yields the tests of the lesson."""
        if self.config.getoption("--labspec"):
            yield from self._claims()
        if _collects_listings(self.config):
            text = self.path.read_bytes().decode("utf-8", "replace")
            for owner, first, last in _labspec.listings(str(self.path), text):
                number = owner.partition("#")[2]
                yield ListingItem.from_parent(self, name=f"listing[{number}]", owner=owner, lines=(first, last))

    def _selected_questions(self) -> set[str]:
        """The questions that arguments name: ``lesson.md::quiz[fall]::2``. Everything from the last name before a bracket is one name to pytest."""
        found = (_TEST_OF_QUESTION.match(argument) for argument in self.config.args)
        return {f"{match[2]}::{match[3]}" for match in found if match}

    def _claims(self) -> Iterator[pytest.Item | pytest.Collector]:
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
        selected = self._selected_questions()
        for quiz, questions in quizzes.items():
            yield QuizGroup.from_parent(self, name=f"quiz[{quiz}]", questions=questions)
            for name, owner in ((f"quiz[{quiz}]::{number}", owner) for number, owner in questions):
                if name in selected:
                    yield ClaimItem.from_parent(self, name=name, owners=(owner,))
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


class _EvidenceItem(pytest.Item):
    """A test that fails with evidence."""

    def __init__(self, *, name: str, parent: pytest.Collector, **more: Any) -> None:
        # As text: `--lf` reads ids from text, and takes brackets for parameters.
        super().__init__(name=name, parent=parent, nodeid=f"{parent.nodeid}::{name}", **more)

    def _lesson(self) -> LessonFile:
        lesson = self.getparent(LessonFile)
        assert lesson is not None
        return lesson

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The evidence, without a traceback."""
        if isinstance(excinfo.value, ClaimFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)


class ClaimItem(_EvidenceItem):
    """The claims of a lab, a question or the text."""

    def __init__(self, *, owners: tuple[str, ...], elsewhere: tuple[str, ...] | None = None, **more: Any) -> None:
        super().__init__(**more)
        self._owners = owners
        #: The owners of the other tests of the lesson, if this one has all that belongs to none of them.
        self._elsewhere = elsewhere

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

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """The place in the lesson."""
        return self.path, None, self.nodeid.partition("::")[2]


class ListingItem(_EvidenceItem):
    """A Python listing with an output below it."""

    def __init__(self, *, owner: str, lines: tuple[int, int], **more: Any) -> None:
        super().__init__(**more)
        self._owner = owner
        self._lines = lines

    def runtest(self) -> None:
        """Runs the listings of the lesson, if that has not been done, and looks at this one."""
        report = self._lesson().listing_report
        if isinstance(report, str):
            raise ClaimFailure(report)
        rows = [row for row in report["ledger"] if row["subject"] == "listing" and row["owner"] == self._owner]
        claims = [_of_json(Claim, row | {"part": row["what"]}) for row in rows]
        first, last = self._lines
        about = [f for f in report["findings"] if f["code"].startswith("listing-") and first <= (f["line"] or 0) <= last]
        findings = [_of_json(Finding, f) for f in about if f["severity"] in _PROBLEMS]
        if not claims:
            raise ClaimFailure(f"{self._owner} is not in the report of `labspec check --listings`; the lesson has changed since its tests were collected")
        failed = [c for c in claims if c.state != "true"]
        if failed or findings:
            raise ClaimFailure(_evidence(failed, findings))

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """The place in the lesson."""
        return self.path, self._lines[0] - 1, self.nodeid.partition("::")[2]


def _of_json(kind: type[_Row], row: dict[str, Any]) -> _Row:
    """A row of the report as an object; other keys are ignored."""
    return kind(**{field.name: row[field.name] for field in fields(kind) if field.name in row})


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
