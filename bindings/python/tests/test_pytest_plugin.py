"""Lessons as tests."""

from pathlib import Path

import pytest

pytest_plugins = ["pytester"]
SPECS = Path(__file__).resolve().parents[3] / "specs"


@pytest.fixture
def lessons(pytester):
    pytester.path.joinpath("models").symlink_to(SPECS / "models")
    text = (SPECS / "lessons/02-bounce-and-swing.md").read_text(encoding="utf-8")
    pytester.path.joinpath("right.md").write_text(text, encoding="utf-8")
    pytester.path.joinpath("notes.md").write_text("# Notes\n\nNo lab here.\n", encoding="utf-8")
    return pytester


def run(pytester, *more):
    return pytester.runpytest("--labspec", "-rs", "-v", *more)


def test_labs_and_questions_are_tests(lessons):
    result = run(lessons)
    counts = result.parseoutcomes()
    assert counts["passed"] >= 8 and "failed" not in counts
    result.stdout.re_match_lines([r"right\.md::lab\[.+\] PASSED.*", r"right\.md::quiz\[.+\]::1 PASSED.*"])
    assert "notes.md" not in result.stdout.str()


def test_a_wrong_key_fails_with_its_evidence(lessons):
    text = lessons.path.joinpath("right.md").read_text(encoding="utf-8")
    at = text.index('"answer": ')
    wrong = text[:at] + '"answer": ' + ("1" if text[at + 10] != "1" else "0") + text[at + 11 :]
    lessons.path.joinpath("wrong.md").write_text(wrong.replace('"id": "', '"id": "w-'), encoding="utf-8")
    result = run(lessons, "wrong.md")
    assert result.parseoutcomes()["failed"] == 1
    result.stdout.fnmatch_lines(["*answer*refuted*", "*error*answer-refuted*"])
    one = run(lessons, "wrong.md", "-k", "lab")
    assert "failed" not in one.parseoutcomes()


def test_what_belongs_to_no_claim_fails_too(lessons):
    right = lessons.path.joinpath("right.md").read_text(encoding="utf-8").replace('"id": "', '"id": "b-')
    lab = '```lab simlba\n{"model": "bounce", "readouts": [{"label": "a", "expr": "data.time"}]}\n```\n'
    lessons.path.joinpath("broken.md").write_text(f"{right}\n{lab}", encoding="utf-8")
    lessons.path.joinpath("alone.md").write_text(f"# Alone\n\n{lab}", encoding="utf-8")
    for name in ("broken.md", "alone.md"):
        result = run(lessons, name)
        outcomes = result.parseoutcomes()
        assert outcomes.get("failed", 0) + outcomes.get("skipped", 0) == 1, outcomes
        result.stdout.fnmatch_lines(["*::text *"])


def test_without_the_option_nothing_is_collected(lessons):
    outcomes = lessons.runpytest().parseoutcomes()
    assert outcomes.keys() <= {"warnings"}
