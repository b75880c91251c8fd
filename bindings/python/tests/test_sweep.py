"""Sweeps: the same numbers on every executor, and those of a run."""

import pickle
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import labspec

LAB = {
    "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='ball' pos='0 0 1'><freejoint/>"
    "<geom name='ball' size='0.1'/></body></worldbody></mujoco>",
    "stopAt": 2,
    "controls": [
        {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": True},
        {"label": "height", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.1, "value": 1, "init": True, "reset": True},
    ],
    "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
}
GRID = {"gravity": [-2, -5, -10], "height": [1, 2]}
MEASURES = {"lands": "first(contact('ball', 'floor'))", "low": "min(data.qpos[2])"}


@pytest.fixture(scope="module")
def serial():
    return labspec.sweep(labspec.Lab(LAB), GRID, MEASURES)


def test_measures_are_those_of_physics(serial):
    assert len(serial) == 6 and serial.errors == (None,) * 6
    for run, lands in zip(serial.params, serial["lands"], strict=True):
        assert lands == pytest.approx(np.sqrt(2 * (run["height"] - 0.1) / -run["gravity"]), abs=0.005)
    columns = serial.columns()
    assert list(columns) == ["gravity", "height", "lands", "low"] and columns["height"] == [1, 2] * 3


def test_every_executor_gives_the_same_bits(serial):
    lab = labspec.Lab(LAB)
    with ThreadPoolExecutor(2) as threads, ProcessPoolExecutor(2, get_context("spawn")) as processes:
        for executor in (threads, processes):
            found = labspec.sweep(lab, GRID, MEASURES, executor=executor)
            assert all(found[name].tobytes() == serial[name].tobytes() for name in MEASURES)

    class Maps:
        def map(self, function, *lists):
            return map(function, *lists)

    found = labspec.sweep(lab, GRID, MEASURES, executor=Maps())
    assert found["lands"].tobytes() == serial["lands"].tobytes()


def test_a_run_without_measures_says_why():
    lab = labspec.Lab(LAB)
    found = labspec.sweep(lab, [{"gravity": -5}, {"gravity": 5}, {"height": 1}], MEASURES, until=1)
    assert found.errors[0] is None and found.errors[2] is None
    assert "5" in found.errors[1] and np.isnan(found["lands"][1])
    wrong = labspec.sweep(lab, {"gravity": [-5]}, {"x": "final(data.qpso[2])"})
    assert "qpso" in wrong.errors[0]


def test_labs_are_pickled_as_they_were_opened():
    lab = labspec.Lab(LAB)
    lab.step(10)
    again = pickle.loads(pickle.dumps(lab))
    assert again.time == 0 and again.json == LAB
