#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for the models of this folder: the reference of tests/parity.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python record.py [CASE ...]

A case is a model, options that differ from the file's, and how it is sampled. Its file holds

  forward     states (the start, then seeded perturbations of it; every other one with applied forces) and
              every field after mj_forward, with the constraint problem solved to rounding
  model       what the compiler makes of the model
  trajectory  qpos and qvel after every so many steps, with the options as they are; the number of contacts
              and of constraint rows after EVERY step, as run lengths [count, repeats]; warnings

Numbers are text, as recording.py writes it.
"""
import json
import pathlib
import sys

import mujoco
import numpy as np

from recording import runs, start, text

HERE = pathlib.Path(__file__).parent
D, E = mujoco.mjtDisableBit, mujoco.mjtEnableBit

# The constraint problem solved to rounding.
TIGHT = {"tolerance": 0.0, "ls_tolerance": 1e-10, "iterations": 200, "ls_iterations": 100}

# name: (model, options, steps, every, scale of the perturbations)
CASES = {
    "free_fall": ("free_fall", {}, 1500, 25, 0.3),
    "ball_drop": ("ball_drop", {}, 1500, 25, 0.02),
    "ball_drop_20ms": ("ball_drop", {"timestep": 0.02}, 1500, 25, None),
    "pendulum": ("pendulum", {}, 1500, 50, 0.5),
    "double_pendulum": ("double_pendulum", {}, 1000, 50, 0.5),
    "double_pendulum_rk4": ("double_pendulum", {"integrator": 1, "timestep": 0.01}, 300, 20, None),
    "ball_pendulum": ("ball_pendulum", {}, 1000, 50, 0.5),
    "springs": ("springs", {}, 1000, 50, 0.3),
    "limits": ("limits", {}, 1000, 50, 0.3),
    "spin": ("spin", {}, 1000, 50, 0.5),
    "spin_rk4": ("spin", {"integrator": 1, "timestep": 0.01}, 300, 20, None),
    "collision": ("collision", {}, 500, 25, 0.15),
    "stack": ("stack", {}, 500, 25, 0.01),
    "stack_rk4": ("stack", {"integrator": 1}, 200, 25, None),
    "rolling": ("rolling", {}, 700, 35, 0.02),
    "rolling_impratio": ("rolling", {"impratio": 10.0}, 300, 25, 0.02),
    "mocap": ("mocap", {}, 400, 25, 0.01),
    "margin": ("margin", {}, 500, 25, 0.005),
    "materials": ("materials", {}, 400, 40, 0.02),
    "mixing": ("mixing", {}, 400, 40, 0.01),
    "override": ("mixing", {
        "enableflags": int(E.mjENBL_OVERRIDE), "o_margin": 0.003, "o_solref": [0.04, 0.9],
        "o_solimp": [0.7, 0.9, 0.002, 0.4, 3.0], "o_friction": [0.3, 0.3, 0.005, 0.0001, 0.0001]}, 200, 40, 0.01),
    # At the default tolerance the library itself is 3e-8 from its own solution when the limit is hit at step 75.
    "tree": ("tree", TIGHT, 300, 25, 0.15),
    "tree_rk4": ("tree", {"integrator": 1}, 100, 25, None),
    "everything": ("everything", {}, 500, 25, 0.05),
}
for flag in ("constraint", "limit", "contact", "spring", "damper", "gravity", "warmstart", "filterparent", "refsafe",
             "eulerdamp", "island"):
    bit = int(getattr(D, "mjDSBL_" + flag.upper()))
    CASES["no_" + flag] = ("everything", {"disableflags": bit}, 200, 40, None)
CASES["no_passive"] = ("everything", {"disableflags": int(D.mjDSBL_SPRING | D.mjDSBL_DAMPER)}, 200, 40, None)

STATE = ("qpos", "qvel", "mocap_pos", "mocap_quat", "qfrc_applied", "xfrc_applied")
FIELDS = ("xpos xquat xipos ximat xanchor xaxis geom_xpos geom_xmat site_xpos site_xmat subtree_com cdof cvel cdof_dot "
          "qfrc_spring qfrc_damper qfrc_passive qfrc_bias qfrc_smooth qacc_smooth qfrc_constraint qacc sensordata energy").split()
ROWS = "efc_type efc_id efc_pos efc_margin efc_diagA efc_D efc_R efc_vel efc_aref efc_force".split()
MODEL = ("body_parentid body_rootid body_weldid body_mocapid body_mass body_inertia body_ipos body_iquat body_pos body_quat "
         "body_subtreemass body_invweight0 dof_invweight0 dof_M0 dof_armature dof_damping qpos0 qpos_spring jnt_type jnt_qposadr "
         "jnt_dofadr jnt_bodyid jnt_limited jnt_range jnt_axis jnt_pos jnt_stiffness jnt_margin jnt_solref jnt_solimp "
         "geom_type geom_bodyid geom_size geom_pos geom_quat geom_friction geom_solref geom_solimp geom_solmix geom_priority "
         "geom_margin geom_gap geom_condim geom_contype geom_conaffinity geom_rbound sensor_adr sensor_dim").split()


def contacts(d):
    """Contacts in a fixed order: by geoms, then place."""
    rows = [(c.geom1, c.geom2, [round(x, 6) for x in c.pos],
             text(np.concatenate([[c.geom1, c.geom2, c.dim, c.exclude, c.dist, c.includemargin, c.mu], c.pos, c.frame, c.friction,
                                  c.solref, c.solimp])))
            for c in d.contact[:d.ncon]]
    return [r[3] for r in sorted(rows, key=lambda r: r[:3])]


def move(m, d, step):
    """Where the mocap body is before a step: polynomials of the time, so that every language agrees on the bits."""
    if m.nmocap:
        t = step * m.opt.timestep
        d.mocap_pos[0] = [0.05 * t, 0.0, 0.2 + 0.1 * t - 0.2 * t * t]


def load(case):
    model, options = CASES[case][:2]
    m = mujoco.MjModel.from_xml_path(str(HERE / "models" / (model + ".xml")))
    for k, v in options.items():
        if np.ndim(getattr(m.opt, k)):
            getattr(m.opt, k)[:] = v
        else:
            setattr(m.opt, k, v)
    return m


def forward(case):
    m, scale = load(case), CASES[case][4]
    if scale is None:
        return []
    for k, v in TIGHT.items():
        setattr(m.opt, k, v)
    d, rng, out = mujoco.MjData(m), np.random.default_rng(2), []
    for k in range(8):
        start(m, d)
        if k:
            mujoco.mj_integratePos(m, d.qpos, rng.normal(size=m.nv) * scale, 1.0)
            d.qvel[:] = rng.normal(size=m.nv)
        if k % 2:
            d.qfrc_applied[:] = rng.normal(size=m.nv)
            d.xfrc_applied[1:] = rng.normal(size=(m.nbody - 1, 6))
        state = {f: text(getattr(d, f)) for f in STATE if getattr(d, f).size}
        mujoco.mj_forward(m, d)
        M = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, M)
        row = {f: text(getattr(d, f)) for f in FIELDS if getattr(d, f).size}
        row.update({f: text(getattr(d, f)) for f in ROWS if d.nefc})
        out.append({"state": state, "data": row, "M": text(M), "contact": contacts(d), "nefc": int(d.nefc)})
    return out


def trajectory(case):
    m, (steps, every) = load(case), CASES[case][2:4]
    d = mujoco.MjData(m)
    start(m, d)
    rows, ncon, nefc = [], [], []
    for i in range(steps + 1):
        if i % every == 0:
            rows.append({"time": text(d.time), "qpos": text(d.qpos), "qvel": text(d.qvel)})
        if i < steps:
            move(m, d, i)
            mujoco.mj_step(m, d)
            ncon.append(int(d.ncon))
            nefc.append(int(d.nefc))
    warnings = {mujoco.mjtWarning(i).name: int(w.number) for i, w in enumerate(d.warning) if w.number}
    return {"steps": steps, "every": every, "rows": rows, "ncon": runs(ncon), "nefc": runs(nefc), "warnings": warnings}


def main(names):
    for case in names or CASES:
        m = load(case)
        out = {
            "mujoco": mujoco.__version__, "model": CASES[case][0],
            "options": {k: text(v) for k, v in CASES[case][1].items()},
            "compiled": {f: text(getattr(m, f)) for f in MODEL if getattr(m, f).size} if CASES[case][4] is not None else {},
            "forward": forward(case), "trajectory": trajectory(case),
        }
        (HERE / (case + ".json")).write_text(json.dumps(out, indent=0) + "\n")
        print(case, (HERE / (case + ".json")).stat().st_size)


if __name__ == "__main__":
    main(sys.argv[1:])
