#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for bodies that touch exactly when the run begins (distance 0, all numbers powers of two):
the contacts of the first forward pass, and the velocities of the first steps. The reference of tests/touching.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python touching.py
"""
import json
import pathlib

import mujoco

HERE = pathlib.Path(__file__).parent
PLANE = "<geom type='plane' size='4 4 1'/>"
BOX = "<geom type='box' size='1 1 .5' pos='0 0 -.5'/>"
# What lies below, the geom above it, and its height.
BALL = "<geom type='sphere' size='.25'/>"
CASES = {}
for below, ground in (("plane", PLANE), ("box", BOX)):
    for above, geom, height in (
        ("sphere", BALL, 0.25),
        ("capsule upright", "<geom type='capsule' size='.25 .5'/>", 0.75),
        ("capsule lying", "<geom type='capsule' size='.25' fromto='-.5 0 0 .5 0 0'/>", 0.25),
        ("cylinder upright", "<geom type='cylinder' size='.25 .5'/>", 0.5),
        ("cylinder lying", "<geom type='cylinder' size='.25' fromto='-.5 0 0 .5 0 0'/>", 0.25),
        ("ellipsoid", "<geom type='ellipsoid' size='.25 .5 .125'/>", 0.125),
        ("box", "<geom type='box' size='.25 .25 .25'/>", 0.25),
    ):
        CASES[f"{above} on {below}"] = (ground, geom, height)
for below, ground in (
    ("sphere", "<geom type='sphere' size='.5' pos='0 0 -.5'/>"),
    ("capsule", "<geom type='capsule' size='.5' fromto='-.5 0 -.5 .5 0 -.5'/>"),
    ("cylinder", "<geom type='cylinder' size='.5 .5' pos='0 0 -.5'/>"),
):
    CASES[f"sphere on {below}"] = (ground, BALL, 0.25)
CASES["capsule on capsule"] = (
    "<geom type='capsule' size='.5' fromto='-.5 0 -.5 .5 0 -.5'/>",
    "<geom type='capsule' size='.25' fromto='0 -.5 0 0 .5 0'/>",
    0.25,
)


def record(ground, geom, height):
    xml = (
        f"<mujoco><option timestep='.0009765625'/><worldbody>{ground}"
        f"<body pos='0 0 {height}'><freejoint/>{geom}</body></worldbody></mujoco>"
    )
    m = mujoco.MjModel.from_xml_string(xml)
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    distances = sorted(c.dist for c in d.contact)
    velocities = []
    for _ in range(4):
        mujoco.mj_step(m, d)
        velocities.append(list(d.qvel))
    return {"xml": xml, "distances": distances, "velocities": velocities}


def main():
    out = {name: record(*case) for name, case in CASES.items()}
    (HERE / "touching.json").write_text(json.dumps(out, indent=1) + "\n")
    for name, case in out.items():
        print(name, case["distances"], ["%.3g" % v for v in case["velocities"][0]], ["%.3g" % v for v in case["velocities"][3]])


if __name__ == "__main__":
    main()
