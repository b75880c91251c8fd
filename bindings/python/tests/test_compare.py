"""Labs on MuJoCo itself: the measures of labspec, and which of them depend on the engine."""

import json
import math
from pathlib import Path

import pytest
from conftest import needs

import labspec

SPECS = Path(__file__).resolve().parents[3] / "specs"
CORPUS = next((folder / "shared/corpus" for folder in Path(__file__).resolve().parents if (folder / "shared/corpus").is_dir()), None)
LAB = {
    "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='ball' pos='0 0 1'><freejoint/>"
    "<geom name='ball' size='0.1'/></body></worldbody></mujoco>",
    "stopAt": 1,
    "controls": [
        {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": True},
        {"label": "height", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.1, "value": 1, "init": True, "reset": True},
        {"type": "button", "label": "kick", "run": "data.qvel[0] += 1"},
    ],
    "controller": "ctx.steps = (ctx.steps || 0) + 1; data.qfrc_applied[0] = 0.1 * ctx.steps",
    "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
}
MEASURES = {
    "lands": "first(contact('ball', 'floor'))",
    "touches": "count(contact('ball'))",
    "speed": "before(contact('ball', 'floor'), data.qvel[2])",
    "reached": "at(data.time > 0.3, data.body('ball').xpos[0])",
    "shown": "final(shown('height (m)'))",
    "energy": "max(lib.energy().total)",
    "force": "final(lib.normalForce('ball'))",
    "crossing": "crossing(data.qpos[2], 0.5)",
    "crossings": "crossings(data.qpos[2], 0.15)",
    "mean": "mean(data.qpos[2])",
    "rms": "rms(data.qvel[2])",
    "integral": "integral(data.qvel[0])",
    "rate": "rate(data.qpos[0])",
    "nested": "first(data.qpos[2] < max(data.qpos[2]) - 0.3)",
    "falls": "first(data.qvel[2] < previous(data.qvel[2]))",
    "extremes": "max(data.qvel[0]) - min(data.qvel[0]) + initial(data.qpos[2])",
    "last": "last(data.qpos[2] > 0.5)",
    "peak": "peak(-data.qpos[2])",
    "settles": "settles(data.qpos[2], 0.1, 0.05)",
    "holds": "holds(data.qpos[2] > 0)",
    "period": "period(data.qvel[2])",
    "never": "first(data.qpos[2] > 100)",
    "accelerations": "final(data.qacc[0])",
}


@pytest.fixture(autouse=True)
def mujoco():
    return needs("mujoco")


def test_measures_are_those_of_mujoco():
    compared = labspec.compare_engines(labspec.Lab(LAB), MEASURES, set={"gravity": -5, "height": 1.5}, press=[("kick", 0.2)])
    assert compared.engine.startswith("MuJoCo ") and [row.measure for row in compared.rows] == list(MEASURES)
    assert compared, str(compared)
    values = {row.measure: row.other for row in compared.rows}
    assert values["lands"] == pytest.approx(math.sqrt(2 * 1.4 / 5), abs=0.003) and math.isnan(values["never"])
    assert "depends on the engine" in str(compared) and "<table>" in compared._repr_html_()


def test_the_steps_are_those_of_mujoco(mujoco):
    model = mujoco.MjModel.from_xml_string(LAB["xml"])
    data = mujoco.MjData(model)
    model.opt.gravity[2], data.qpos[2] = -5, 1
    mujoco.mj_forward(model, data)
    there = labspec.MujocoLab(labspec.Lab(LAB))
    there["gravity"] = -5
    for step in range(1, 51):
        data.qfrc_applied[0] = 0.1 * step
        mujoco.mj_step(model, data)
        there.step()
    assert there.data.qpos.tobytes() == data.qpos.tobytes() and there.data.qvel.tobytes() == data.qvel.tobytes()
    assert there.values() == [data.qpos[2]] and there["gravity"] == -5


def test_programs_may_call_functions_of_the_engine():
    controls = [
        {"label": "mass", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "min": 1, "max": 9, "step": 1, "value": 2, "reset": True},
        {"type": "button", "label": "back", "run": "mj.mj_resetData(model, data); data.qpos[2] = 0.5; mj.mj_forward(model, data); ctx.top = data.body('ball').xpos[2]"},
    ]
    lab = labspec.Lab({**LAB, "controls": controls, "controller": "ctx.top = ctx.top || 0"})
    measures = {"rest": "1e6 * final(data.qpos[2])", "mass": "final(model.body_subtreemass[0])", "weight": "final(model.body_invweight0[2])"}
    measures |= {"time": "final(data.time)", "top": "final(ctx.top)", "force": "final(lib.normalForce('ball'))"}
    compared = labspec.compare_engines(lab, measures, set={"mass": 7}, press=[("back", 0.3)])
    assert compared, str(compared)
    assert compared["mass"].other == 7 and compared["top"].other == 0.5


def test_another_engine_is_noticed(monkeypatch):
    # An engine that falls faster.
    step = labspec.MujocoLab.step

    def faster(self):
        self.data.qvel[2] -= 1e-3
        step(self)

    monkeypatch.setattr(labspec.MujocoLab, "step", faster)
    compared = labspec.compare_engines(labspec.Lab(LAB), {"lands": "first(contact('ball', 'floor'))", "gravity": "final(model.opt.gravity[2])"})
    assert not compared and [row.depends for row in compared.rows] == [True, False]


def test_the_claims_of_a_lab_are_compared():
    compared = labspec.compare_engines(labspec.Lab(f"{SPECS / 'lessons/02-bounce-and-swing.md'}#1"))
    assert compared["bouncy.apex"].other == pytest.approx(0.297, abs=5e-4) and not compared["bouncy.apex"].depends
    assert compared["bouncy.h"].other == 2 and compared["stiff_fine.h"].other == 1
    assert compared.verdicts >= 7 and {row.owner for row in compared.rows} == {"lab #1"}
    assert compared, str(compared)


def test_the_claims_of_a_lesson_are_compared():
    reported = []
    # Its sliders set masses, and the constants that follow from them.
    compared = labspec.compare_engines(SPECS / "lessons/08-ropes-and-gears.md", progress=reported.append)
    assert len({row.owner for row in compared.rows}) > 3 and compared.verdicts > 10 and reported
    assert not compared.findings and not any(row.depends for row in compared.rows), str(compared)


def test_a_verdict_that_depends_on_the_engine_is_a_finding(monkeypatch):
    step = labspec.MujocoLab.step

    def slower(self):
        step(self)
        self.data.qvel[:] *= 0.999

    monkeypatch.setattr(labspec.MujocoLab, "step", slower)
    compared = labspec.compare_engines(labspec.Lab(f"{SPECS / 'lessons/02-bounce-and-swing.md'}#1"))
    assert not compared and compared["bouncy.apex"].depends and not compared["bouncy.h"].depends
    assert any(f.code == "engine-dependent" and "0.297 m" in f.message for f in compared.findings), str(compared)
    assert "engine-dependent" in str(compared)


@pytest.mark.parametrize("name", ["1.2_01_simlab", "physics-lab_03_simlab"])
def test_labs_of_the_corpus_do_not_depend_on_the_engine(name):
    if CORPUS is None:
        pytest.skip("the corpus is not here")
    lab = labspec.Lab(json.loads((CORPUS / f"labs/{name}.json").read_text(encoding="utf-8")), CORPUS / "models")
    measures = {d.label: f"final(shown({json.dumps(d.label)}))" for d in lab.displayed}
    measures |= {f"qpos[{i}]": f"final(data.qpos[{i}])" for i in range(int(lab.model.nq))}
    compared = labspec.compare_engines(lab, measures, until=0.5)
    assert compared.rows and not any(row.depends for row in compared.rows), str(compared)


def test_a_run_that_breaks_is_broken_in_both(mujoco, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lab = labspec.Lab({**LAB, "controller": "data.qfrc_applied[2] = data.time > 0.1 ? 1e30 : 0"})
    there = labspec.MujocoLab(lab)
    values = there.measure({"highest": "max(data.qpos[2])", "steps": "count(data.time < 0.003)"}, steps=200)
    assert "a bad number" in there.broke and there.warnings > 0 and values["steps"] > 1
    assert not list(tmp_path.iterdir()), "MuJoCo writes no log"
    compared = labspec.compare_engines(lab, {"steps": "count(data.time < 0.003)"}, until=0.4)
    assert compared["steps"].other == values["steps"] and compared["steps"].labspec == values["steps"]
    frozen = labspec.MujocoLab(labspec.Lab({**LAB, "controller": "if (data.time > 0.1) { ctx.nothing.x = 1 }"}))
    frozen.measure({"end": "final(data.time)"}, steps=200)
    assert "the controller failed" in frozen.broke and frozen.time < 0.2


def test_impossible_comparisons_are_refused():
    lab = labspec.Lab(LAB)
    with pytest.raises(labspec.LabspecError, match="qpso") as caught:
        labspec.compare_engines(lab, {"x": "final(data.qpso[2])"})
    assert caught.value.findings
    with pytest.raises(labspec.LabspecError, match="no claim"):
        labspec.compare_engines(lab)
    with pytest.raises(ValueError, match="their own lengths"):
        labspec.compare_engines(lab, until=1)
    there = labspec.MujocoLab(lab)
    with pytest.raises(KeyError, match="nothing"):
        there["nothing"] = 1
    with pytest.raises(labspec.LabspecError, match="is a button"):
        there["kick"] = 1
    with pytest.raises(labspec.LabspecError, match="not a button"):
        there.press("gravity")
    with pytest.raises(labspec.LabspecError, match="qpso"):
        labspec.MujocoLab(labspec.Lab({**LAB, "setup": "data.qpso = 1"}))
