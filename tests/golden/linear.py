#!/usr/bin/env python3
"""Records M, Jacobians and the linearization of a step for models of `specs/models`: the reference of
crates/core/tests/linear.rs.

    pip install mujoco==3.14.0
    python tests/golden/linear.py

Each model runs for 20 steps from its first keyframe with velocities of its own, by Euler's method (`mjd_transitionFD` refuses
Runge-Kutta) and with the solver's tolerance at 0, so that a step is a function of its state. Then `mj_fullM`, `mj_jacBody` of
the last body, `mj_jac` of a point beside it, and `mjd_transitionFD`, centered and forward. Matrices are lists by rows; numbers
have all their digits. Matrices without a row or a column are left out of the call.
"""
import json
import pathlib

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
MODELS = ["servo", "gears", "hoist", "joints", "pinch", "double_pendulum", "zoo/sensor_joints", "zoo/actuator_dynamics"]
EPS = 1e-6


def record(name):
    m = mujoco.MjModel.from_xml_path(str(HERE / f"../../specs/models/{name}.xml"))
    m.opt.integrator, m.opt.tolerance = mujoco.mjtIntegrator.mjINT_EULER, 0
    d = mujoco.MjData(m)
    if m.nkey:
        mujoco.mj_resetDataKeyframe(m, d, 0)
    d.qvel += 0.1 * np.cos(np.arange(m.nv))
    for _ in range(20):
        mujoco.mj_step(m, d)
    mujoco.mj_forward(m, d)
    fields = ["qpos", "qvel", "act", "ctrl", "qacc_warmstart"]
    out = {"model": name, "eps": EPS, **{field: getattr(d, field).tolist() for field in fields}}
    full = np.zeros((m.nv, m.nv))
    mujoco.mj_fullM(m, d, full)
    out["full_m"] = full.ravel().tolist()
    body = m.nbody - 1
    point = d.xpos[body] + [0.1, -0.2, 0.3]
    out |= {"body": body, "point": point.tolist()}
    jacp, jacr = np.zeros((3, m.nv)), np.zeros((3, m.nv))
    mujoco.mj_jacBody(m, d, jacp, jacr, body)
    out |= {"jac_body_p": jacp.ravel().tolist(), "jac_body_r": jacr.ravel().tolist()}
    mujoco.mj_jac(m, d, jacp, jacr, point, body)
    out |= {"jac_p": jacp.ravel().tolist(), "jac_r": jacr.ravel().tolist()}
    n = 2 * m.nv + m.na
    for centered in (0, 1):
        shapes = {"a": (n, n), "b": (n, m.nu), "c": (m.nsensordata, n), "d": (m.nsensordata, m.nu)}
        matrices = {key: np.zeros(shape) for key, shape in shapes.items()}
        mujoco.mjd_transitionFD(m, d, EPS, centered, *(x if x.size else None for x in matrices.values()))
        way = "centered" if centered else "forward"
        out |= {f"{key}_{way}": x.ravel().tolist() for key, x in matrices.items()}
    return out


assert mujoco.__version__ == "3.14.0"
(HERE / "linear.json").write_text(json.dumps([record(name) for name in MODELS], indent=0) + "\n")
