#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for the models of our own lessons, specs/models: the reference of tests/scenery.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python course.py [MODEL ...]

course/MODEL.json holds the compiled constants, two states with every field after a forward pass, and a trajectory for each
integrator, all with constraints switched off. course.json holds runs with everything switched on: each model as it is, and as
the lessons set it. A setting is a field, an index and a value.
"""
import json
import math
import pathlib
import sys

import mujoco
import numpy as np

import recording

HERE = pathlib.Path(__file__).parent
MODELS = HERE.parent.parent / "specs/models"


def tilted(angle, turn=0.0):
    """Gravity as on a slope."""
    a, t = math.radians(angle), math.radians(turn)
    g = [9.81 * math.sin(a) * math.cos(t), 9.81 * math.sin(a) * math.sin(t), -9.81 * math.cos(a)]
    return [["opt.gravity", i, x] for i, x in enumerate(g)]


def contact(constant):
    """The time constant of both geoms."""
    return [["geom_solref", 0, constant], ["geom_solref", 2, constant]]


def servo(h, kv, integrator=0):
    return [["opt.timestep", 0, h], ["actuator_biasprm", 2, -kv], ["opt.integrator", 0, integrator]]


# name of the model: its runs, each with its settings, the state that it starts with (beyond the keyframe), and its length in s
RUNS = {
    "bounce": [([], [], 1.0), ([["geom_solref", 1, 1.0], ["geom_solref", 3, 1.0]], [], 1.0)],
    "double_pendulum": [([], [], 2.0)],
    "drop": [([], [], 1.0), ([["opt.timestep", 0, 0.02]], [], 2.0)],
    "fall": [([], [], 0.5), ([["opt.timestep", 0, 0.01]], [], 0.5)],
    "pendulum": [([], [], 3.0), ([], [["qpos", 0, 1.5]], 3.0)],
    "two_balls": [([], [], 1.0), ([["geom_solref", 1, 1.0], ["geom_solref", 3, 1.0]], [], 1.0)],
    "pressed": [([], [], 1.0), (contact(0.04), [], 1.0), (contact(0.01) + [["opt.timestep", 0, 0.02]], [], 1.0),
                ([["geom_solimp", i, 0.8] for i in (0, 1, 5, 6)] + contact(0.03), [], 1.0)],
    "slope": [(tilted(20), [], 1.0), (tilted(26), [], 1.0), (tilted(30), [], 1.0),
              (tilted(24, 45) + [["opt.cone", 0, 0]], [], 1.0), (tilted(24, 45), [], 1.0), (tilted(19, 45) + [["opt.cone", 0, 0]], [], 1.0)],
    "servo": [([], [], 1.0), (servo(0.09, 0), [], 5.0), (servo(0.11, 0), [], 1.0), (servo(0.04, 40), [], 5.0), (servo(0.05, 40), [], 0.5),
              (servo(0.11, 40, 3), [], 5.0)],
    "spring": [(([["opt.timestep", 0, 0.05]]), [], 10.0), ([["opt.timestep", 0, 0.05], ["opt.integrator", 0, 1]], [], 10.0)],
    "twins": [([], [["qpos", 0, 2.5], ["qpos", 2, 2.501]], 3.0), ([], [["qpos", 0, 0.1], ["qpos", 2, 0.1001]], 5.0)],
    "joints": [([], [], 6.5)],
    "hoist": [([], [], 0.5)],
    "gears": [([], [], 1.0), ([], [["ctrl", 0, 0.05]], 1.0)],
    "pinch": [([], [], 2.0), ([["opt.impratio", 0, 10.0]], [], 2.0), ([["opt.impratio", 0, 10.0], ["opt.cone", 0, 0]], [], 2.0),
              ([], [["ctrl", 0, 3.0], ["ctrl", 1, 3.0]], 0.5)],
    "book": [([], [["qvel", 3, 0.01], ["qvel", 4, 6.0], ["qvel", 5, 0.01]], 3.0), ([], [["qvel", 3, 6.0], ["qvel", 4, 0.01], ["qvel", 5, 0.01]], 6.0)],
}
ROWS = 20


def write(owner, settings):
    for name, index, value in settings:
        of, field = (owner.opt, name[4:]) if name.startswith("opt.") else (owner, name)
        if np.ndim(getattr(of, field)):
            getattr(of, field).ravel()[index] = value
        else:
            setattr(of, field, value)


def run(path, settings, state, until):
    m = mujoco.MjModel.from_xml_path(str(path))
    write(m, settings)
    d = mujoco.MjData(m)
    recording.start(m, d)
    write(d, state)
    steps = round(until / m.opt.timestep)
    every = max(1, steps // ROWS)
    rows, contacts = [], []
    for i in range(1, steps + 1):
        mujoco.mj_step(m, d)
        contacts.append(int(d.ncon))
        if i % every == 0:
            rows.append({"qpos": recording.text(d.qpos), "qvel": recording.text(d.qvel), "qfrc_constraint": recording.text(d.qfrc_constraint)})
    return {"set": settings, "state": state, "every": every, "rows": rows, "ncon": recording.runs(contacts)}


def main(names):
    models = sorted(p.stem for p in MODELS.glob("*.xml"))
    assert models == sorted(RUNS), "each model has its runs"
    for name in names or models:
        size = recording.write(HERE / "course" / (name + ".json"), recording.record(MODELS / (name + ".xml"), 2, 0.1, steps=100, every=50))
        print(f"{size:8} {name}")
    runs = {name: [run(MODELS / (name + ".xml"), *r) for r in RUNS[name]] for name in models}
    print(f"{recording.write(HERE / 'course.json', {'mujoco': mujoco.__version__, 'models': runs}):8} runs")


if __name__ == "__main__":
    main(sys.argv[1:])
