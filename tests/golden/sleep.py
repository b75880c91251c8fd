#!/usr/bin/env python3
"""Records how trees of models/sleep*.xml fall asleep in MuJoCo 3.14.0 and what wakes them: the reference of tests/sleep.rs.

    mj/bin/python sleep.py

sleep.json holds, for each scene, what is written to the data before which step, and for each integrator and solver rows of
fields after steps.
"""
import json

import mujoco
import numpy as np

from recording import INTEGRATORS, text
from zoo import HERE

FIELDS = ("tree_asleep tree_awake body_awake ntree_awake nbody_awake nparent_awake nv_awake qpos qvel act qacc qacc_smooth "
          "qfrc_smooth qfrc_bias subtree_com cam_xpos light_xpos light_xdir ten_length ten_J ten_wrapadr "
          "ten_wrapnum ten_velocity actuator_length  actuator_velocity actuator_force act_dot "
          "qfrc_actuator sensordata energy").split()
# What constraints do to trees that sleep.
HELD = ("tree_asleep body_awake ntree_awake nbody_awake nparent_awake nv_awake ncon nefc nisland qpos qvel qacc "
        "qacc_smooth qfrc_constraint sensordata energy").split()
ALL = {name: {"integrator": i} for i, name in enumerate(INTEGRATORS)}
# The dual solver and the removal of slip run to convergence: what they find after a few sweeps depends on the order of the sweeps.
SOLVERS = {"noslip": {"noslip_iterations": 20_000, "noslip_tolerance": 0}, "ellipse": {"cone": 1}}
DUAL = {"solver": 0, "iterations": 20_000, "tolerance": 0}
# Before this step: field, element, value.
SCENES = {
    "sleep": (700, FIELDS, ALL, [
        (0, "ctrl", 0, 0.1), (0, "ctrl", 1, 0.2), (3, "qvel", 4, 5e-3), (60, "ctrl", 0, 0.5), (70, "qpos", 4, 0.2),
        (230, "eq_active", 0, 1), (236, "eq_active", 0, 0), (300, "qfrc_applied", 0, 1e-3), (310, "qfrc_applied", 0, 0),
        (420, "mocap_pos", 0, 1.0), (440, "xfrc_applied", 6 * 3 + 1, 0.5), (441, "xfrc_applied", 6 * 3 + 1, 0.0),
        (560, "qpos", 6, 0.3), (570, "qvel", 0, 0.01)]),
    # A ball that hits, a hand that presses, a push, a box that is lifted.
    "sleep_pile": (1000, HELD, {**ALL, **SOLVERS}, [
        (0, "qvel", 0, 0.3), (150, "qvel", 18, 1.5), (500, "mocap_pos", 2, 0.49), (520, "mocap_pos", 2, 3.0),
        (800, "xfrc_applied", 6 * 3, 0.5), (801, "xfrc_applied", 6 * 3, 0.0), (900, "qpos", 2, 0.35)]),
    # Limits and dry friction at rest; equalities that are switched on between trees that sleep; a tendon pulled tight.
    "sleep_ties": (1500, HELD, {**ALL, **SOLVERS, "dual": DUAL}, [
        (0, "qvel", 1, 0.3), (0, "qvel", 2, 0.4), (200, "qvel", 0, 0.5), (400, "eq_active", 0, 1), (600, "eq_active", 0, 0),
        (700, "qvel", 4, 0.3), (900, "eq_active", 4, 1), (1100, "qfrc_applied", 8, 0.1), (1110, "qfrc_applied", 8, 0.0),
        (1300, "eq_active", 3, 1)]),
}


def run(scene, options):
    steps, fields, _, writes = SCENES[scene]
    m = mujoco.MjModel.from_xml_path(str(HERE / f"models/{scene}.xml"))
    for name, value in options.items():
        setattr(m.opt, name, value)
    d, rows, last, after = mujoco.MjData(m), [], None, False
    for step in range(steps):
        written = [w for w in writes if w[0] == step]
        for _, field, i, value in written:
            getattr(d, field).flat[i] = value
        mujoco.mj_step(m, d)
        # What changed, and what follows from that. With Runge-Kutta a tree that falls asleep wakes in the next step.
        state = d.tree_awake.copy()
        new = bool(written) or m.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4 and bool((state != last).any())
        if new or after or step % 100 == 10:
            rows.append({"step": step, **{f: text(np.asarray(getattr(d, f))) for f in fields}})
        last, after = state, new
    return {"options": options, "rows": rows}


out = {scene: {"writes": writes, "runs": {name: run(scene, options) for name, options in runs.items()}}
       for scene, (_, _, runs, writes) in SCENES.items()}
(HERE / "sleep.json").write_text(json.dumps(out, indent=0) + "\n")
