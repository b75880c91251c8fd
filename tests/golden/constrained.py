#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes with constraints, solved to rounding: the reference of tests/constrained.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python constrained.py [--states 4] [--shared 2] [--out constrained] [NAME ...]

Our own models (constrained/*.xml) with each of their options: every field of the constraint rows. The models of ../shared,
which are not copied here: accelerations and forces.
"""
import argparse
import itertools
import pathlib

import mujoco
import numpy as np

import recording

HERE = pathlib.Path(__file__).parent
SHARED = HERE.parent.parent.parent / "shared"
FOLDERS = {"conformance": "conformance/models", "corpus": "corpus/models", "bench": "bench"}

# The constraint problem solved to rounding.
TIGHT = {"tolerance": 0.0, "ls_tolerance": 1e-10, "iterations": 200, "ls_iterations": 100}
RESULTS = "qacc qfrc_constraint sensordata".split()
ROWS = ("efc_type efc_id efc_pos efc_margin efc_frictionloss efc_diagA efc_KBIP efc_D efc_R efc_vel efc_aref efc_b efc_force "
        "efc_state").split()
MORE = "qacc_smooth qfrc_passive qfrc_adhesion cfrc_ext cfrc_int cacc ne nf nl nefc ncon nisland".split()

D, E = mujoco.mjtDisableBit, mujoco.mjtEnableBit
# Sweeps to convergence: orders and momentum differ between the library and ours, the minimum does not.
DUAL = {"solver": 0, "iterations": 20000}
NOSLIP = {"noslip_iterations": 20000, "noslip_tolerance": 0.0}
CONES = {"pyramid": {"cone": 0}, "ellipse": {"cone": 1}}
# Options of our own models besides both cones, by the beginning of the model's name.
VARIANTS = {
    "impratio": {"impratio": 7.0},
    "exact": {"enableflags": int(E.mjENBL_DIAGEXACT)},
    "unsafe": {"disableflags": int(D.mjDSBL_REFSAFE), "timestep": 0.02},
    "safe": {"timestep": 0.02},
    "override": {"enableflags": int(E.mjENBL_OVERRIDE), "o_margin": 0.004, "o_solref": [0.03, 0.8],
                 "o_solimp": [0.7, 0.93, 0.002, 0.4, 3.0], "o_friction": [0.4, 0.6, 0.01, 0.002, 0.003]},
    "together": {"disableflags": int(D.mjDSBL_ISLAND)},
    "sparse": {"jacobian": 1},
    "discrete": {"integrator": 4},
    "discrete stiff": {"integrator": 4, "timestep": 0.02},
    "discrete dual": {"integrator": 4, **DUAL},
    # The path of conjugate gradients, which do not arrive at the solution.
    "gradients": {"solver": 1, "iterations": 6},
    "dual": DUAL,
    "dual together": {**DUAL, "disableflags": int(D.mjDSBL_ISLAND)},
    "noslip": NOSLIP,
    "dual noslip": {**DUAL, **NOSLIP},
}


def apply(m, options):
    for k, v in options.items():
        if np.ndim(getattr(m.opt, k)):
            getattr(m.opt, k)[:] = v
        else:
            setattr(m.opt, k, v)


def record(m, count, scale, chosen, options={}):
    apply(m, TIGHT)
    apply(m, options)
    d, out = mujoco.MjData(m), []
    for state in recording.states(m, d, count, scale, seed=2):
        mujoco.mj_forward(m, d)
        mujoco.mj_rnePostConstraint(m, d)
        out.append({"state": state, "data": recording.fields(d, chosen)})
    return out


def main():
    p = argparse.ArgumentParser()
    p.add_argument("names", nargs="*")
    p.add_argument("--states", type=int, default=3)
    p.add_argument("--shared", type=int, default=2)
    p.add_argument("--out", type=pathlib.Path, default=HERE / "constrained")
    a = p.parse_args()
    for path in sorted((HERE / "constrained").glob("*.xml")):
        if a.names and path.stem not in a.names:
            continue
        cases = []
        for (cone, one), (name, other) in itertools.product(CONES.items(), {"": {}, **VARIANTS}.items()):
            m = mujoco.MjModel.from_xml_path(str(path))
            apply(m, {**one, **other})
            found = record(m, a.states, 0.05, RESULTS + ROWS + MORE, {**one, **other})
            if name != "together":
                # The library leaves the states of islands in an order of their own.
                found = [{**s, "data": {k: v for k, v in s["data"].items() if k != "efc_state"}} for s in found]
            # A variant need not show everything again.
            found = [{**s, "data": {k: v for k, v in s["data"].items() if k not in MORE}} for s in found[1:2]] if name else found
            cases.append({"case": f"{cone} {name}".strip(), "options": {**one, **other}, "states": found})
        size = recording.write(a.out / (path.stem + ".json"), {"mujoco": mujoco.__version__, "cases": cases})
        print(f"{size:8} {path.stem}")
    for kind, folder in FOLDERS.items():
        for path in sorted((SHARED / folder).glob("*.xml")):
            name = kind + "/" + path.stem
            if a.names and name not in a.names:
                continue
            m = mujoco.MjModel.from_xml_path(str(path))
            # As the model is, before the solver is tightened.
            path = recording.trajectory(m, m.opt.integrator, True, 0.1, 2, steps=100, every=50, others=12)
            case = {"case": "", "options": {}, "states": record(m, a.shared, 0.1, RESULTS + ["ncon", "nefc"])}
            out = {"mujoco": mujoco.__version__, "cases": [case], "trajectory": path}
            size = recording.write(a.out / (name + ".json"), out)
            print(f"{size:8} {name}")


if __name__ == "__main__":
    main()
