"""Precision, stability and verification of labs: the numbers of the program's JSON."""

import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import labspec

SPECS = Path(__file__).resolve().parents[3] / "specs"
LESSON = SPECS / "lessons/02-bounce-and-swing.md"
#: What depends on the machine.
TIMES = ("microsecondsPerSecond", "repeats", "timeRatio", "front", "advice")


def output(program, *arguments):
    done = subprocess.run([program, *map(str, arguments), "--format", "json"], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    return json.loads(done.stdout)


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def test_precision_has_the_numbers_of_the_program(program):
    reported = []
    found = labspec.Lab(f"{LESSON}#2").precision(until=0.2, integrators=["Euler", "RK4"], set={"start": 1.5}, progress=reported.append)
    expected = output(program, "precision", f"{LESSON}#2", "--until", 0.2, "--integrator", "Euler", "--integrator", "RK4", "--set", "start=1.5")
    assert without_times(found.json) == without_times(expected)
    assert reported and all(isinstance(text, str) for text in reported)
    assert found.reference and found.own.timestep and len(found.rows) == len(expected["rows"])
    for row, raw in zip(found.rows, expected["rows"], strict=True):
        assert row.work == raw["work"] and row.integrator in ("Euler", "RK4")
        assert [None if x is None or math.isnan(x) else x for x in row.errors] == raw["errors"]
    assert found.chart.startswith("<svg") and found.traces


def test_stability_has_the_numbers_of_the_program(program):
    found = labspec.Lab(f"{LESSON}#1").stability(until=0.3, margins=True)
    expected = output(program, "stability", f"{LESSON}#1", "--until", 0.3, "--margins")
    assert without_times(found.json) == without_times(expected)
    assert found.fine == bool(found) == expected["fine"] and found.runs == len(expected["runs"])
    assert [m.largest for m in found.margins] == [m["largest"] for m in expected["margins"]]
    assert found.chart is None


def test_checks_have_the_measures_of_the_program(program):
    report = labspec.check(LESSON)
    expected = output(program, "check", LESSON, "--no-cache")
    raw = dict(expected["lessons"][0])
    assert {k: v for k, v in report.json.items() if k != "file"} == {k: v for k, v in raw.items() if k != "file"}
    assert report.verifications and report.verifications[0]["bouncy.apex"] == pytest.approx(0.297, abs=5e-4)
    verified = labspec.Lab(f"{LESSON}#1").verify()
    assert verified and verified.outcome == "clean" and [v.owner for v in verified.verifications] == [report.verifications[0].owner]
    assert verified.verifications[0].measures == report.verifications[0].measures


def test_a_question_is_verified_with_its_lab():
    lesson = SPECS / "lessons"
    path, address = next(
        (path, f"#{quiz}.1")
        for path in sorted(lesson.glob("*.md"))
        for quiz in _quizzes_with_a_sim(path.read_text(encoding="utf-8"))
    )
    report = labspec.Lab(f"{path}{address}").verify()
    assert report.claims and all(c.owner.startswith(f"quiz {address[1:-2]}, question 1") for c in report.claims)


def _quizzes_with_a_sim(text):
    for block in text.split("```quiz\n")[1:]:
        quiz = json.loads(block.split("```")[0])
        if "sim" in quiz["questions"][0] and "verify" in quiz["questions"][0]:
            yield quiz["id"]


def test_other_claims_about_a_lab_are_verified():
    lab = labspec.Lab(f"{LESSON}#1")
    runs = {"bouncy": {"until": 1.5}, "dead": {"set": {"damping ratio": 1}, "until": 1.5}}
    found = lab.verify({"runs": runs, "measure": {"apex": "max(data.time > 0.45 ? data.joint('ball').qpos[2] : 0)"}})
    measures = found.verifications[0]
    assert measures["bouncy.apex"] == pytest.approx(0.297, abs=5e-4) and measures["dead.apex"] < 0.041
    wrong = lab.verify({"measure": {"x": "final(data.qpso[2])"}})
    assert not wrong and any("qpso" in f.message for f in wrong.findings)


@pytest.mark.parametrize(
    ("call", "refusal"),
    [
        (lambda lab: lab.precision(integrators=["Eulr"]), (ValueError, "Eulr")),
        (lambda lab: lab.precision(vary=["x"]), (ValueError, "iterations")),
        (lambda lab: lab.precision(until=math.nan), (labspec.LabspecError, ".")),
        (lambda lab: lab.precision(set={"nothing": 1}), (labspec.LabspecError, "nothing")),
        (lambda lab: lab.precision(set={"damping ratio": [1]}), (TypeError, "number")),
        (lambda lab: lab.stability(until=-1), (labspec.LabspecError, ".")),
        (lambda lab: lab.stability(map=("nothing", "damping ratio")), (labspec.LabspecError, "nothing")),
        (lambda lab: lab.stability(press=[("damping ratio", 0.1)]), (labspec.LabspecError, "button")),
        (lambda lab: lab.precision(until=0.1, progress=lambda _text: 1 / 0), (ZeroDivisionError, ".")),
    ],
)
def test_impossible_calls_are_refused(call, refusal):
    with pytest.raises(refusal[0], match=refusal[1]):
        call(labspec.Lab(f"{LESSON}#1"))


def test_a_lab_with_errors_has_no_reports():
    lab = labspec.Lab({"xml": "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>", "setup": "data.qpso = 1"})
    with pytest.raises(labspec.LabspecError, match="qpso") as caught:
        lab.precision()
    assert caught.value.findings


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_long_work():
    # A shell may start the tests in the background, where it ignores the signal, and children inherit that.
    code = f"""
import signal
import labspec
signal.signal(signal.SIGINT, signal.default_int_handler)
lab = labspec.Lab({f"{LESSON}#3"!r})
print("started", flush=True)
lab.stability(until=1e4, margins=True)
"""
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "started\n"
    time.sleep(0.5)
    assert child.poll() is None, child.stderr.read()
    begin = time.monotonic()
    os.kill(child.pid, signal.SIGINT)
    assert child.wait(timeout=20) != 0 and time.monotonic() - begin < 10
    assert "KeyboardInterrupt" in child.stderr.read()


def test_a_lab_without_a_lesson_verifies_its_claims(tmp_path):
    lab = {
        "xml": "<mujoco><option integrator='RK4'/><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
        "stopAt": 1,
        "plots": [{"traces": [{"label": "ball", "expr": "data.qpos[2]"}]}],
        "verify": {"exact": {"ball": "1 - 0.5 * 9.81 * data.time ** 2"}},
    }
    verified = labspec.Lab(lab).verify()
    assert verified and [c.word for c in verified.claims if c.subject == "closed form"] == ["verified"]
    refuted = labspec.Lab(lab).verify({"exact": {"ball": "1 - 0.5 * 9.8 * data.time ** 2"}})
    assert not refuted and [f.code for f in refuted.findings] == ["closed-form-wrong"]
    lesson = "".join(f"\n```lab\n{json.dumps({**lab, 'verify': {'exact': {'ball': text}}})}\n```\n" for text in ("1", "1 - 4.905 * data.time ** 2"))
    path = tmp_path / "lesson.md"
    path.write_text(lesson, encoding="utf-8")
    assert [labspec.Lab(f"{path}#{number}").verify().outcome for number in (1, 2)] == ["findings", "clean"]
