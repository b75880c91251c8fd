"""Labs and checks: the numbers of `labspec run` and the verdicts of `labspec check`."""

import csv
import io
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import labspec

SPECS = Path(__file__).resolve().parents[3] / "specs"
LESSON = SPECS / "lessons/02-bounce-and-swing.md"


def test_a_lab_is_played_as_on_a_page():
    lab = labspec.Lab(f"{LESSON}#1")
    assert lab.time == 0 and not lab.is_over and lab.controls and lab.displayed
    steps = lab.play_to(0.1)
    assert steps == round(0.1 / lab.timestep) and lab.time == pytest.approx(0.1)
    state = lab.save()
    first = lab.record(steps=50)
    lab.restore(state)
    second = lab.record(steps=50)
    assert first.values.tobytes() == second.values.tobytes() and len(first) == 51
    label = lab.displayed[0].label
    assert first[label][0] == first.values[0, 0]
    with pytest.raises(KeyError, match="nothing is displayed"):
        first["nothing"]
    lab.reset()
    assert lab.time == 0


def test_controls_take_what_a_student_can_choose():
    lab = labspec.Lab(f"{LESSON}#1")
    slider = next(c for c in lab.controls if c.kind == "slider")
    lab[slider.label] = slider.max
    assert lab[slider.label] == slider.max
    with pytest.raises(labspec.LabspecError):
        lab[slider.label] = slider.max + 1
    with pytest.raises(KeyError, match="has no control"):
        lab["nothing"] = 1
    with pytest.raises(TypeError):
        lab[slider.label] = [1]


def test_lessons_are_checked():
    report = labspec.check(LESSON)
    assert report and report.outcome == "clean" and not [f for f in report.findings if f.severity == "error"]
    assert any(c.subject == "answer" and c.word == "verified" for c in report.claims)
    text = LESSON.read_text(encoding="utf-8")
    wrong = labspec.check(LESSON, text=text.replace("data.", "dta."), models=SPECS / "models")
    assert not wrong and any(f.code == "unknown-name" for f in wrong.findings)
    assert "dta" in str(wrong)


@pytest.mark.skipif("LABSPEC" not in os.environ, reason="LABSPEC names no program")
@pytest.mark.parametrize("number", [1, 2, 3])
def test_the_numbers_are_those_of_the_program(number):
    address = f"{LESSON}#{number}"
    lab = labspec.Lab(address)
    done = subprocess.run([os.environ["LABSPEC"], "run", address, "--until", "0.5", "--format", "csv"], capture_output=True, text=True, check=True)
    rows = list(csv.reader(io.StringIO(done.stdout)))[1:]
    recorded = lab.record(until=0.5)
    assert len(rows) == len(recorded)
    for row, time, values in zip(rows, recorded.times, recorded.values, strict=True):
        assert float(row[0]) == time
        assert [float(x) for x in row[1:]] == pytest.approx(list(values), rel=0, abs=0, nan_ok=True)
    assert np.isfinite(recorded.values).all()
