#!/usr/bin/env python3
"""Records the mass slider of a ball drop, moved while the balls are in flight: the reference of tests/numbers.rs.

At t = 0.2 s the light ball becomes 5 kg; then mj_setConst, which puts qpos back to the start and keeps qvel, and
mj_forward, as a page does after a control. Numbers as in record.py.
"""
import json
import pathlib

import mujoco

from record import HERE, text

m = mujoco.MjModel.from_xml_path(str(HERE / "models/ball_drop.xml"))
d = mujoco.MjData(m)
mujoco.mj_forward(m, d)
rows = []


def sample():
    rows.append({"time": text(d.time), "qpos": text(d.qpos), "qvel": text(d.qvel), "ncon": int(d.ncon)})


for _ in range(100):
    mujoco.mj_step(m, d)
sample()
m.body_mass[2] = 5
mujoco.mj_setConst(m, d)
mujoco.mj_forward(m, d)
sample()
for _ in range(20):
    for _ in range(50):
        mujoco.mj_step(m, d)
    sample()
(pathlib.Path(__file__).parent / "slider.json").write_text(json.dumps(rows, indent=0) + "\n")
