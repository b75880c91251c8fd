"""Lessons as tests."""

import json
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from conftest import listing_settings, needs

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
    again = run(lessons, "wrong.md", "--lf").parseoutcomes()
    assert again["failed"] == 1 and "passed" not in again
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


LISTINGS = """# A fall

```python
import course
course.note(1)
print(f"t = {(2 * 0.95 / course.G) ** 0.5:.4f} s")
```
Output:
```text
t = 0.4401 s
```

```python file=examples/speed.py
import course
course.note(2)
print("v =", 4.317, "m/s")
```

Output:

```text
v = 4.317 m/s
```

```python
import course
course.note(3)
print(-1)
```

Output:

```text
-1
```
"""


@pytest.fixture
def listings(pytester, monkeypatch):
    """A lesson with three listings, which note in a file of the folder that they run. Nothing is stored outside of the folder."""
    trace = json.dumps(str(pytester.path / "trace"))
    pytester.path.joinpath("course.py").write_text(f"G = 9.81\n\ndef note(n):\n    open({trace}, 'a').write(str(n))\n", encoding="utf-8")
    settings = listing_settings(f"python = {json.dumps(sys.executable)}", 'files = ["course.py"]')
    pytester.path.joinpath("labspec.toml").write_text(settings, encoding="utf-8")
    pytester.path.joinpath("fall.md").write_text(LISTINGS, encoding="utf-8")
    monkeypatch.setenv("LABSPEC_CACHE", "")
    return pytester


def runs(listings):
    """The numbers of the listings that ran, in order."""
    trace = listings.path / "trace"
    return trace.read_text(encoding="utf-8") if trace.exists() else ""


def change(listings, old, new):
    text = listings.path.joinpath("fall.md").read_text(encoding="utf-8")
    assert old in text
    listings.path.joinpath("fall.md").write_text(text.replace(old, new), encoding="utf-8")


def test_listings_are_tests_and_run_once(listings):
    result = listings.runpytest("--labspec-listings", "-v", "-rs")
    assert result.parseoutcomes() == {"passed": 3}
    result.stdout.fnmatch_lines([f"fall.md::listing[[]{n}] PASSED*" for n in (1, 2, 3)])
    assert runs(listings) == "123"


def test_the_setting_runs_listings_beside_labs(listings):
    listings.makeini("[pytest]\nlabspec_listings = true\n")
    assert listings.runpytest().parseoutcomes() == {"passed": 3}
    both = listings.runpytest("--labspec", "-v")
    both.stdout.fnmatch_lines(["*listing[[]3] PASSED*"])
    assert both.parseoutcomes()["passed"] >= 3


def test_nothing_runs_by_default(listings):
    for options in ([], ["--labspec"], ["--labspec-listings", "--collect-only"]):
        listings.runpytest(*options)
        assert runs(listings) == ""


def test_a_changed_digit_fails_with_both_texts_and_the_place(listings):
    change(listings, "v = 4.317 m/s\n```", "v = 4.318 m/s\n```")
    result = listings.runpytest("--labspec-listings", "--junit-xml", "report.xml")
    assert result.parseoutcomes() == {"failed": 1, "passed": 2}
    result.stdout.fnmatch_lines(["*listing[[]2]*", "*fall.md:22:5: error[[]listing-output]: the lesson shows `4.318`, the listing prints `4.317`", "*help: write*"])
    cases = {case.get("name"): case for case in ElementTree.parse(listings.path / "report.xml").iter("testcase")}
    assert sorted(cases) == [f"listing[{n}]" for n in (1, 2, 3)]
    assert "prints `4.317`" in cases["listing[2]"].find("failure").text and cases["listing[1]"].find("failure") is None


def test_options_select_listings(listings):
    change(listings, "\n-1\n", "\n-2\n")
    assert listings.runpytest("--labspec-listings", "-k", "listing and 2").parseoutcomes() == {"passed": 1, "deselected": 2}
    assert listings.runpytest("--labspec-listings", "fall.md::listing[1]").parseoutcomes() == {"passed": 1}
    assert listings.runpytest("--labspec-listings").parseoutcomes() == {"failed": 1, "passed": 2}
    assert listings.runpytest("--labspec-listings", "--lf").parseoutcomes() == {"failed": 1}


def test_a_listing_that_raises_fails_at_its_line(listings):
    change(listings, 'print("v =", 4.317, "m/s")', "print(1 / 0)")
    result = listings.runpytest("--labspec-listings")
    assert result.parseoutcomes() == {"failed": 1, "passed": 2}
    result.stdout.fnmatch_lines(["*fall.md:16:1: error[[]listing-fails]*ZeroDivisionError*"])


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ('[listings]\npython = "nowhere/python"\n', "*nowhere/python does not run*"),
        ("[listings]\nsecond = 5\n", "*exit code 2*did you mean `seconds`*"),
        ("[listings]\nseconds = 0\n", "*exit code 2*from 1 to 3600*"),
    ],
)
def test_what_cannot_be_run_fails(listings, settings, message):
    listings.path.joinpath("labspec.toml").write_text(settings, encoding="utf-8")
    result = listings.runpytest("--labspec-listings")
    assert result.parseoutcomes() == {"failed": 3}
    result.stdout.fnmatch_lines([message])
    assert runs(listings) == ""


def test_what_the_settings_ignore_fails(listings):
    change(listings, "\n-1\n", "\n-2\n")
    settings = listings.path / "labspec.toml"
    settings.write_text('ignore = ["listing-output"]\n' + settings.read_text(encoding="utf-8"), encoding="utf-8")
    assert listings.runpytest("--labspec-listings").parseoutcomes() == {"failed": 1, "passed": 2}


def test_a_lesson_that_changes_after_its_tests_were_collected_fails(listings):
    listings.makeconftest(
        "def pytest_collection_finish(session):\n"
        "    path = session.config.rootpath / 'fall.md'\n"
        "    path.write_text(path.read_text(encoding='utf-8').replace('```text\\n-1', '```json\\n-1'), encoding='utf-8')\n"
    )
    result = listings.runpytest("--labspec-listings")
    assert result.parseoutcomes() == {"failed": 1, "passed": 2}
    result.stdout.fnmatch_lines(["*has changed since its tests were collected*"])


def test_hostile_files_are_collected(listings):
    listings.path.joinpath("fall.md").write_bytes(LISTINGS.encode() + b"\xff\xfe")
    listings.path.joinpath("-x.md").write_text(LISTINGS, encoding="utf-8")
    listings.path.joinpath("empty.md").write_bytes(b"")
    result = listings.runpytest("--labspec-listings", ".")
    assert result.parseoutcomes() == {"passed": 6}


def cases(pytester, name="report.xml"):
    """The outcomes in a report of JUnit, by class and name: "passed", or the element and its text."""
    found = {}
    for case in ElementTree.parse(pytester.path / name).iter("testcase"):
        details = [(child.tag, (child.text or "") + (child.get("message") or "")) for child in case if child.tag in ("failure", "skipped", "error")]
        found[case.get("classname"), case.get("name")] = details[0] if details else ("passed", "")
    return found


_XML = "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"
_LAB = {"title": "A fall", "xml": _XML, "stopAt": 0.1, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}


def _question(text, answer):
    verify = {"lab": "#1", "runs": {"fall": {"until": 0.1}}, "measure": {"end": "final(data.qpos[2])"}, "options": ["fall.end < 0.96", "fall.end > 0.99"]}
    options = ["It is lower", "It does not move"]
    return {"kind": "mcq", "q": text, "options": options, "answer": answer, "explain": "It falls.", "verify": verify}


@pytest.fixture
def both(listings):
    """A lesson with a lab, a quiz and listings: the second of three questions has a wrong key, and the second of three listings another output."""
    quiz = {"id": "fall", "questions": [_question(f"Where is the ball, {i}?", int(i == 2)) for i in (1, 2, 3)]}
    blocks = f"```lab simlab\n{json.dumps(_LAB)}\n```\n\n```quiz\n{json.dumps(quiz)}\n```\n"
    text = LISTINGS.replace("# A fall\n", f"# A fall\n\n{blocks}").replace("v = 4.317 m/s\n```", "v = 4.318 m/s\n```")
    listings.path.joinpath("fall.md").write_text(text, encoding="utf-8")
    return listings


ALL = ("--labspec", "--labspec-listings", "fall.md")


def test_a_report_of_junit_has_every_test_with_its_evidence(both):
    result = both.runpytest(*ALL, "--junit-xml", "report.xml")
    outcomes, found = result.parseoutcomes(), cases(both)
    assert outcomes["failed"] == 2 and len(found) == sum(outcomes[kind] for kind in ("failed", "passed", "skipped") if kind in outcomes)
    failed = {name: text for name, (kind, text) in found.items() if kind == "failure"}
    listing = failed.pop(("fall.md", "listing[2]"))
    assert "the lesson shows `4.318`, the listing prints `4.317`" in listing
    evidence = failed.pop(("fall.md.quiz[fall]", "2"))
    assert not failed and "refuted" in evidence and "error[answer-refuted]" in evidence
    kinds = {name.partition("[")[0] for group, name in found if group == "fall.md"}
    assert kinds == {"lab", "listing", "text"} and ("fall.md", "listing[3]") in found
    assert not any(kind == "error" for kind, _text in found.values())


def test_selections_and_last_failures_of_both_kinds(both):
    assert both.runpytest(*ALL, "-k", "listing").parseoutcomes().keys() == {"failed", "passed", "deselected"}
    quiz = both.runpytest(*ALL, "-k", "quiz and not listing").parseoutcomes()
    assert (quiz["failed"], quiz["passed"]) == (1, 2)
    assert runs(both) == "1223", "a listing that differs runs twice, and what is not selected does not run"
    first = both.runpytest(*ALL).parseoutcomes()
    assert first["failed"] == 2

    def again(*more):
        return {kind: n for kind, n in both.runpytest(*ALL, "--lf", *more).parseoutcomes().items() if kind != "deselected"}

    assert again() == {"failed": 2}
    assert again("-k", "listing") == {"failed": 1}
    change(both, "v = 4.318", "v = 4.317")
    assert again() == {"failed": 1, "passed": 1}
    assert again() == {"failed": 1}


def test_two_workers_give_the_same_outcomes(both):
    needs("xdist")
    serial = both.runpytest_subprocess(*ALL, "--junit-xml", "serial.xml").parseoutcomes()
    result = both.runpytest_subprocess(*ALL, "-n", "2", "--junit-xml", "report.xml")
    assert result.parseoutcomes() == serial and serial["failed"] == 2
    assert cases(both) == cases(both, "serial.xml") and len(cases(both)) == 8
    result.stdout.fnmatch_lines_random(["*error[[]listing-output]: the lesson shows `4.318`, the listing prints `4.317`", "*error[[]answer-refuted]*"])


def ids(result):
    """The ids of questions and listings in the summary."""
    names = [line.split(" ")[1] for line in result.outlines if line.startswith(("FAILED ", "PASSED "))]
    return [name for name in names if name.startswith(("fall.md::quiz", "fall.md::listing"))]


def test_the_summary_names_tests_as_they_are_selected(both):
    result = both.runpytest(*ALL, "-rfp")
    found = ids(result)
    assert sorted(found) == [*(f"fall.md::listing[{n}]" for n in (1, 2, 3)), *(f"fall.md::quiz[fall]::{n}" for n in (1, 2, 3))]
    again = both.runpytest("--labspec", "--labspec-listings", "-rfp", *found)
    assert sorted(ids(again)) == sorted(found) and again.parseoutcomes() == {"failed": 2, "passed": len(found) - 2}
    assert both.runpytest("--labspec", "fall.md::quiz[fall]::2").parseoutcomes() == {"failed": 1}
    assert both.runpytest("--labspec", "fall.md::quiz[fall]").parseoutcomes() == {"failed": 1, "passed": 2}
    assert both.runpytest(*ALL, "fall.md::quiz[fall]::2").parseoutcomes() == result.parseoutcomes(), "nothing is tested twice"
    assert both.runpytest("--labspec", "fall.md::quiz[fall]::27").ret == pytest.ExitCode.USAGE_ERROR


def test_two_workers_name_and_select_the_same_tests(both):
    needs("xdist")
    found = ids(both.runpytest(*ALL, "-rfp"))
    parallel = both.runpytest_subprocess("--labspec", "--labspec-listings", "-n", "2", "-rfp", *found)
    assert sorted(ids(parallel)) == sorted(found) and parallel.parseoutcomes()["failed"] == 2


def test_two_workers_select_and_repeat(both):
    needs("xdist")
    selected = both.runpytest_subprocess(*ALL, "-n", "2", "-k", "listing").parseoutcomes()
    assert (selected["failed"], selected["passed"]) == (1, 2)
    assert both.runpytest_subprocess(*ALL, "-n", "2").parseoutcomes()["failed"] == 2
    again = both.runpytest_subprocess(*ALL, "-n", "2", "--lf", "--junit-xml", "report.xml").parseoutcomes()
    assert again == {"failed": 2}
    assert sorted(name for _group, name in cases(both)) == ["2", "listing[2]"]


def test_a_worker_for_each_lesson_runs_its_listings_once(listings):
    needs("xdist")
    other = LISTINGS.replace("course.note(1)", "course.note(4)").replace("course.note(2)", "course.note(5)").replace("course.note(3)", "course.note(6)")
    listings.path.joinpath("other.md").write_text(other, encoding="utf-8")
    result = listings.runpytest_subprocess("--labspec-listings", "-n", "2", "--dist", "loadfile")
    assert result.parseoutcomes() == {"passed": 6}
    assert sorted(runs(listings)) == list("123456")
