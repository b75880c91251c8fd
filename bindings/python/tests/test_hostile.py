"""Whatever is passed, a call works or raises an exception of Python: never a panic."""

import json
import math
import random

import pytest

import labspec
from labspec import _labspec

LAB = {
    "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='ball' pos='0 0 1'><freejoint/>"
    "<geom name='ball' size='0.1'/></body></worldbody><actuator/></mujoco>",
    "stopAt": 0.1,
    "controls": [
        {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": True},
        {"type": "select", "label": "kind", "param": "kind", "options": [["a", 1], ["b", "x"]], "value": 1},
        {"type": "button", "label": "kick", "run": "data.qvel[0] += 1"},
    ],
    "plots": [{"traces": [{"label": "z", "expr": "data.qpos[2]"}]}],
    "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
}
WEIRD = [None, True, -1, 0, 1, 2**31, 2**64, -(2**70), 1e308, -0.5, math.nan, math.inf, "", "\0", "gravity", "kick", "#1", "#x.1", "é" * 50, "\ud800"]
WEIRD += [b"", b"\xff", [], [1], ["a"], {}, {"a": 1}, (), (1, 2), {"path": "a.md", "text": "", "address": None}, {"path": "l.json", "text": json.dumps(LAB), "address": None}]
WEIRD += [{"until": 0.01, "set": [], "press": []}, {"until": math.nan, "set": [("gravity", [])], "press": [("kick", math.nan)]}, object(), lambda *_args: None]
#: Refusals of Python and of labspec. A panic would be a `BaseException`.
REFUSALS = (TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, RuntimeError, OSError, BufferError, labspec.LabspecError)
FUNCTIONS = ("check", "claimed_runs", "cross_check", "lab_json", "measure", "precision", "stability")
STEPS = ("step", "play_to", "record")


def refused_or_works(call, *arguments):
    try:
        return call(*arguments)
    except REFUSALS:
        return None


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_take_anything(name):
    draw = random.Random(name)
    for _ in range(300):
        refused_or_works(getattr(_labspec, name), *(draw.choice(WEIRD) for _ in range(draw.randrange(7))))


@pytest.mark.parametrize("kind", ["Lab", "Evaluator"])
def test_methods_take_anything(kind):
    draw = random.Random(kind)
    text = json.dumps(LAB)
    made = _labspec.Lab.from_json(text) if kind == "Lab" else _labspec.Evaluator({"path": "lab.json", "text": text, "address": None})
    names = [name for name in dir(made) if not name.startswith("_") and callable(getattr(made, name))]
    weird = [x for x in WEIRD if not isinstance(x, (int, float)) or isinstance(x, bool) or not abs(x) > 1000]
    for _ in range(3000):
        name = draw.choice(names)
        choices = weird if name in STEPS else WEIRD
        refused_or_works(getattr(made, name), *(draw.choice(choices) for _ in range(draw.randrange(4))))


@pytest.mark.parametrize("seed", range(5))
def test_labs_that_are_cut_or_changed_are_refused_or_work(seed):
    draw = random.Random(seed)
    text = json.dumps(LAB)
    for _ in range(60):
        i, j = sorted(draw.sample(range(len(text)), 2))
        changed = draw.choice([text[:i], text[:i] + text[j:], text[:i] + draw.choice("{}[],:\"'<>\\0é") + text[i + 1 :]])
        lab = refused_or_works(_labspec.Lab.from_json, changed)
        if lab is not None:
            refused_or_works(lab.record, 5, 1)
        refused_or_works(_labspec.Evaluator, {"path": "lab.json", "text": changed, "address": None})
        refused_or_works(_labspec.check, "lab.json", changed, None, None, "claims")


def test_programs_without_end_are_ended():
    lab = labspec.Lab({**LAB, "controller": "for (let i = 0; i >= 0; i++) { ctx.x = i }"})
    with pytest.raises(labspec.LabspecError):
        lab.step()
    programs = _labspec.Evaluator({"path": "lab.json", "text": json.dumps({**LAB, "setup": "for (let i = 0; i >= 0; i++) { ctx.x = i }"}), "address": None})
    with pytest.raises(labspec.LabspecError):
        programs.setup()
