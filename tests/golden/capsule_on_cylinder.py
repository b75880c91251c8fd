#!/usr/bin/env python3
"""Records how many contacts MuJoCo 3.14.0 gives a capsule that lies on the end of a cylinder, at random in space.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python tests/golden/capsule_on_cylinder.py [N]

Writes capsule_on_cylinder.txt, for each case a line: contacts | depth of the line of the capsule below the end, m | tilt, rad
| how far its line is from the rim, m | model. A third of the cases is tilted by 1e-9 to 1e-5 rad; in a third the capsule's line is near the rim.
"""
import pathlib
import sys

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
rng = np.random.default_rng(5)


def words(v):
    return " ".join(repr(float(x)) for x in np.ravel(v))


def case():
    R, H = round(rng.uniform(0.03, 0.2), 3), round(rng.uniform(0.05, 0.3), 3)
    r, L = round(rng.uniform(0.01, 0.06), 3), round(rng.uniform(0.03, 0.25), 3)
    depth = rng.choice([1e-3, 1e-5, 5e-3]) * min(1, r / 0.02)
    kind = rng.integers(3)
    tilt = 10 ** rng.uniform(-9, -5) if kind == 1 else 0.0
    off = R * (1 - 10 ** rng.uniform(-4, -1)) if kind == 2 else R * rng.uniform(0, 0.9) * (rng.random() < 0.7)
    turn, along = rng.uniform(0, 2 * np.pi), rng.uniform(-1, 1) * L * (rng.random() < 0.5)
    u, w = np.array([np.cos(turn), np.sin(turn), 0]), np.array([-np.sin(turn), np.cos(turn), 0])
    centre = u * along + w * off + np.array([0, 0, H + r - depth])
    quat = np.zeros(4)
    mujoco.mju_quatZ2Vec(quat, u * np.cos(tilt) + np.array([0, 0, np.sin(tilt)]))
    whole = rng.normal(size=4)
    whole /= np.linalg.norm(whole)
    pos, turned = np.zeros(3), np.zeros(4)
    mujoco.mju_rotVecQuat(pos, centre, whole)
    mujoco.mju_mulQuat(turned, whole, quat)
    xml = (f"<mujoco><worldbody><geom type='cylinder' size='{R} {H}' quat='{words(whole)}'/><body pos='{words(pos)}' quat='{words(turned)}'>"
           f"<freejoint/><geom type='capsule' size='{r} {L}'/></body></worldbody></mujoco>")
    m = mujoco.MjModel.from_xml_string(xml)
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    return f"{d.ncon}|{float(depth)!r}|{float(tilt)!r}|{float(R - off)!r}|{xml}"


lines = [case() for _ in range(int(sys.argv[1]) if len(sys.argv) > 1 else 200)]
(HERE / "capsule_on_cylinder.txt").write_text("\n".join(lines) + "\n")
