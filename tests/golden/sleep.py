#!/usr/bin/env python3
"""Records how trees of models/sleep.xml fall asleep in MuJoCo 3.14.0 and what wakes them: the reference of tests/sleep.rs.

    mj/bin/python sleep.py

sleep.json holds, for each integrator, what is written to the data before which step, and rows of fields after steps.
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
# Before this step: field, element, value.
WRITES = [(0, "ctrl", 0, 0.1), (0, "ctrl", 1, 0.2), (3, "qvel", 4, 5e-3), (60, "ctrl", 0, 0.5), (70, "qpos", 4, 0.2),
          (230, "eq_active", 0, 1), (236, "eq_active", 0, 0), (300, "qfrc_applied", 0, 1e-3), (310, "qfrc_applied", 0, 0),
          (420, "mocap_pos", 0, 1.0), (440, "xfrc_applied", 6 * 3 + 1, 0.5), (441, "xfrc_applied", 6 * 3 + 1, 0.0),
          (560, "qpos", 6, 0.3), (570, "qvel", 0, 0.01)]
STEPS = 700


def run(integrator):
    m = mujoco.MjModel.from_xml_path(str(HERE / "models/sleep.xml"))
    m.opt.integrator = integrator
    d, rows, last, after = mujoco.MjData(m), [], None, False
    for step in range(STEPS):
        written = [w for w in WRITES if w[0] == step]
        for _, field, i, value in written:
            getattr(d, field).flat[i] = value
        mujoco.mj_step(m, d)
        # What changed, and what follows from that. With Runge-Kutta a tree that falls asleep wakes in the next step.
        state = d.tree_awake.copy()
        new = bool(written) or integrator != mujoco.mjtIntegrator.mjINT_RK4 and bool((state != last).any())
        if new or after or step % 100 == 10:
            rows.append({"step": step, **{f: text(np.asarray(getattr(d, f))) for f in FIELDS}})
        last, after = state, new
    return rows


out = {"writes": WRITES, "steps": STEPS, "runs": {name: run(i) for i, name in enumerate(INTEGRATORS)}}
(HERE / "sleep.json").write_text(json.dumps(out, indent=0) + "\n")
