"""Sweeps: the same numbers on every executor, and those of a run."""

import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from conftest import needs

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


class _Counts:
    """An executor that counts its tasks, and loses a worker after some of them."""

    def __init__(self, most):
        self.made, self.most = 0, most

    def map(self, function, tasks):
        for task in tasks:
            if self.made == self.most:
                raise RuntimeError("a worker was lost")
            self.made += 1
            yield function(task)


MANY = {"gravity": [round(-2 - 0.1 * i, 1) for i in range(80)], "height": [1, 1.5, 2]}


def test_a_stored_sweep_continues_after_an_error(tmp_path):
    needs("pyarrow")
    lab, reported = labspec.Lab(LAB), []
    serial = labspec.sweep(lab, MANY, MEASURES)
    folder = tmp_path / "runs"
    with pytest.raises(RuntimeError, match="lost"):
        labspec.sweep(lab, MANY, MEASURES, executor=_Counts(2), out=folder)
    assert sorted(p.name for p in folder.iterdir()) == ["part-000000.parquet", "part-000001.parquet", "sweep.json"]
    executor = _Counts(99)
    again = labspec.sweep(lab, MANY, MEASURES, executor=executor, out=folder, progress=lambda done, of: reported.append((done, of)))
    assert executor.made == 2 and reported == [(192, 240), (240, 240)]
    assert all(again[name].tobytes() == serial[name].tobytes() for name in MEASURES) and again.params == serial.params
    import pyarrow.parquet

    table = pyarrow.parquet.read_table([str(p) for p in sorted(folder.glob("*.parquet"))]).to_pydict()
    assert table["height"] == [run["height"] for run in serial.params] and table["measure/lands"] == serial["lands"].tolist()


def test_a_killed_sweep_is_the_serial_one(tmp_path):
    needs("pyarrow")
    folder, measures = tmp_path / "runs", {**MEASURES, "late": "final(data.qpos[2])"}
    code = (
        f"import labspec\nmany = {MANY!r}\nmany['gravity'] = [x for x in many['gravity'] for _ in range(10)]\n"
        f"labspec.sweep(labspec.Lab({LAB!r}), many, {measures!r}, out={str(folder)!r})"
    )
    child = subprocess.Popen([sys.executable, "-c", code])
    end = time.monotonic() + 60
    while len(list(folder.glob("*.parquet"))) < 2 and child.poll() is None and time.monotonic() < end:
        time.sleep(0.005)
    child.kill()
    child.wait()
    written = {path: path.stat().st_mtime_ns for path in folder.glob("part-*.parquet")}
    assert 2 <= len(written) < 38, "it was killed in the middle"
    many = {**MANY, "gravity": [x for x in MANY["gravity"] for _ in range(10)]}
    lab = labspec.Lab(LAB)
    again = labspec.sweep(lab, many, measures, out=folder)
    serial = labspec.sweep(lab, many, measures)
    assert all(again[name].tobytes() == serial[name].tobytes() for name in measures) and again.errors == serial.errors
    assert all(path.stat().st_mtime_ns == then for path, then in written.items()), "what was written was not run again"


def test_another_sweep_does_not_continue_in_the_folder(tmp_path):
    needs("pyarrow")
    lab = labspec.Lab(LAB)
    labspec.sweep(lab, GRID, MEASURES, out=tmp_path)
    with pytest.raises(ValueError, match="a different sweep"):
        labspec.sweep(lab, GRID, {"x": "final(data.qpos[0])"}, out=tmp_path)
    with pytest.raises(ValueError, match="a different sweep"):
        labspec.sweep(labspec.Lab({**LAB, "stopAt": 1}), GRID, MEASURES, out=tmp_path)
    (tmp_path / "part-000000.parquet").write_bytes(b"junk")
    with pytest.raises(ValueError, match="not part of this sweep"):
        labspec.sweep(lab, GRID, MEASURES, out=tmp_path)


def test_designs_fill_the_ranges_of_sliders():
    needs("scipy")
    lab = labspec.Lab(LAB)
    for design in (labspec.sobol, labspec.latin_hypercube):
        runs = design(lab, 16, seed=3)
        assert runs == design(lab, 16, seed=3) != design(lab, 16, seed=4) and len(runs) == 16
        heights = sorted(run["height"] for run in runs)
        assert heights[0] <= 0.6 and heights[-1] >= 1.9 and all(-20 <= run["gravity"] <= -1 for run in runs)
        found = labspec.sweep(lab, runs, MEASURES)
        assert len(found) == 16 and not any(error and "between" in error for error in found.errors)
        assert set(design(lab, 2, ["height"])[0]) == {"height"}
        with pytest.raises(KeyError, match="nothing"):
            design(lab, 4, ["nothing"])
        with pytest.raises(ValueError):
            design(lab, 0)


def test_joblib_gives_the_same_bits(serial):
    joblib = needs("joblib")
    found = labspec.sweep(labspec.Lab(LAB), GRID, MEASURES, executor=joblib.Parallel(n_jobs=2))
    assert all(found[name].tobytes() == serial[name].tobytes() for name in MEASURES)


def test_dask_gives_the_same_bits_though_a_worker_is_lost(serial):
    needs("distributed")
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        found = labspec.sweep(labspec.Lab(LAB), GRID, MEASURES, executor=client)
        assert all(found[name].tobytes() == serial[name].tobytes() for name in MEASURES)
        many = labspec.sweep(labspec.Lab(LAB), MANY, MEASURES)
        worker = next(iter(cluster.workers.values()))
        lost = labspec.sweep(labspec.Lab(LAB), MANY, MEASURES, executor=_Kills(client, worker.pid))
        assert all(lost[name].tobytes() == many[name].tobytes() for name in MEASURES)


class _Kills:
    """A client of Dask, whose worker is killed after the first task was submitted."""

    def __init__(self, client, pid):
        self._client, self._pid = client, pid

    def submit(self, function, *arguments):
        future = self._client.submit(function, *arguments, pure=False)
        if self._pid is not None:
            os.kill(self._pid, signal.SIGKILL)
            self._pid = None
        return future


def test_ray_gives_the_same_bits(serial):
    ray = needs("ray")
    from ray.util.multiprocessing import Pool

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, configure_logging=False)
    try:
        with Pool(2) as pool:
            found = labspec.sweep(labspec.Lab(LAB), GRID, MEASURES, executor=pool)
    finally:
        ray.shutdown()
    assert all(found[name].tobytes() == serial[name].tobytes() for name in MEASURES)
