"""Single runs of a lab: the bits of a sweep, in every process, and the samples of `labspec run`."""

import csv
import json
import pickle
import subprocess
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from itertools import product, repeat
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import labspec

LAB = {
    "title": "A fall",
    "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='ball' pos='0 0 1'><freejoint/>"
    "<geom name='ball' size='0.1'/></body></worldbody></mujoco>",
    "stopAt": 1,
    "controls": [
        {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": True},
        {"label": "height", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.1, "value": 1, "init": True, "reset": True},
        {"label": "h", "set": "model.opt.timestep", "min": 0.001, "max": 0.01, "step": 0.001, "value": 0.002, "reset": True},
    ],
    "plots": [{"ylabel": "height (m)", "traces": [{"label": "z", "expr": "data.qpos[2]"}]}],
    "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[2]"}, {"label": "text", "expr": "'no number'"}],
}
MEASURES = {"lands": "first(contact('ball', 'floor'))", "end": "final(data.qpos[2])", "fastest": "min(data.qvel[2])"}
POINTS = [{"gravity": g, "height": h} for g, h in product([-2, -5, -10], [1, 2])] + [{}, {"h": 0.005}]


def bits(runs, name):
    return np.array([run[name] for run in runs]).tobytes()


@pytest.fixture(scope="module")
def serial():
    return labspec.sweep(labspec.Lab(LAB), POINTS, MEASURES)


def test_a_run_has_the_bits_of_a_sweep(serial):
    lab = labspec.Lab(LAB)
    lab["gravity"] = -3
    lab.step(7)
    runs = [lab.run(point, MEASURES) for point in POINTS]
    assert all(bits(runs, name) == serial[name].tobytes() for name in MEASURES)
    assert [run.params for run in runs] == POINTS and all(run.error is None and run.recording is None for run in runs)
    assert lab["gravity"] == -3 and lab.time == 7 * lab.timestep, "the lab is where it was"
    longer = lab.run({"height": 2}, MEASURES, until=1.5)
    assert longer["end"] == labspec.sweep(lab, [{"height": 2}], MEASURES, until=1.5)["end"][0] != lab.run({"height": 2}, MEASURES)["end"]


def test_a_pickled_run_has_the_same_bits_in_other_processes(serial):
    lab = labspec.Lab(LAB)
    again = pickle.loads(pickle.dumps(lab.run))
    assert bits([again(point, MEASURES) for point in POINTS], "end") == serial["end"].tobytes()
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        runs = list(pool.map(lab.run, POINTS, repeat(MEASURES)))
        submitted = [pool.submit(partial(lab.run, measures=MEASURES, every=10), point) for point in POINTS]
        recorded = [future.result() for future in submitted]
    for name in MEASURES:
        assert bits(runs, name) == bits(recorded, name) == serial[name].tobytes()
    here = lab.run(POINTS[3], every=10).recording
    assert recorded[3].recording.values.tobytes() == here.values.tobytes() and recorded[3].recording.plots() == here.plots()


def test_threads_can_run_the_same_lab(serial):
    lab = labspec.Lab(LAB)
    with ThreadPoolExecutor(4) as pool:
        runs = list(pool.map(partial(lab.run, measures=MEASURES, every=1), POINTS * 4))
    assert bits(runs, "end") == serial["end"].tobytes() * 4
    assert all(run.recording.lab is not lab for run in runs), "a lab belongs to one thread at a time"


@pytest.mark.parametrize("until", [None, 0.3, 1.7])
def test_a_recording_has_the_bits_of_the_measures(until):
    lab = labspec.Lab(LAB)
    for point in POINTS:
        run = lab.run(point, MEASURES, until=until, every=1)
        recording = run.recording
        assert recording["z"][-1] == run["end"] and recording["speed (m/s)"].min() == run["fastest"]
        assert recording.times[0] == 0 and recording.times[-1] == pytest.approx(until or 1)
        assert np.isnan(recording["text"]).all()
        sparse = lab.run(point, until=until, every=7).recording
        assert sparse.values[1].tobytes() == recording.values[7].tobytes() and sparse.times[-1] == recording.times[-1]
    assert len(lab.run().recording) == 501 and lab.run().values == {}


def test_a_recording_has_the_samples_of_the_program(program, tmp_path):
    file = tmp_path / "lab.json"
    file.write_text(json.dumps(LAB), encoding="utf-8")
    command = [program, "run", str(file), "--set", "gravity=-5", "--set", "height=1.5", "--until", "0.5", "--every", "3", "--format", "csv"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = [[float(cell) for cell in row[:3]] for row in list(csv.reader(text.splitlines()))[1:]]
    recording = labspec.Lab(file).run({"gravity": -5, "height": 1.5}, until=0.5, every=3).recording
    assert np.column_stack([recording.times, recording.values[:, :2]]).tolist() == rows


def test_labs_of_lessons_run():
    lesson = Path(__file__).resolve().parents[3] / "specs/lessons/02-bounce-and-swing.md"
    lab = labspec.Lab(f"{lesson}#1")
    run = lab.run({}, {"end": "final(data.qpos[0])"}, until=0.5, every=5)
    assert run["end"] == labspec.sweep(lab, [{}], {"end": "final(data.qpos[0])"}, until=0.5)["end"][0]
    assert [d.label for d in run.recording.displayed] == [d.label for d in lab.displayed]


@pytest.mark.parametrize("point", [{"gravity": 5}, {"gravity": -5.05}, {"height": "high"}, {"nothing": 1}])
def test_a_run_that_cannot_be_made_says_why(point):
    lab = labspec.Lab(LAB)
    swept = labspec.sweep(lab, [point], MEASURES)
    run = lab.run(point, MEASURES, every=1)
    assert run.error == swept.errors[0] and run.recording is None and set(run.values) == set(MEASURES)
    assert all(np.isnan(value) for value in run.values.values())
    alone = lab.run(point)
    assert alone.error and alone.recording is None and next(iter(point)) in alone.error


def test_wrong_arguments_are_refused():
    lab = labspec.Lab(LAB)
    assert "qpso" in lab.run({}, {"x": "final(data.qpso[2])"}).error
    assert lab.run({}, until=-1).error and lab.run({}, until=1e9).error
    with pytest.raises(ValueError, match="at least 1 step"):
        lab.run({}, every=0)
    with pytest.raises(TypeError):
        lab.run({"gravity": []})
    with pytest.raises(KeyError):
        lab.run({}, MEASURES)["nothing"]
