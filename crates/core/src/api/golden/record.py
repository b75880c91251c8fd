"""Records what the sensors of each model of this folder read in MuJoCo 3.14.0: `python record.py` with
mujoco==3.14.0 and numpy.

Writes, beside each NAME.xml, NAME.txt with one line per field: its name, then its numbers in full precision. Lines
`model.FIELD` are constants; every line `state` begins a state, inputs first, then what mj_forward makes of it. Where past values are kept, every line
`step` begins a step from there.
"""

import pathlib

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
STATES = 8
STEPS = 24
INPUTS = "time qpos qvel act ctrl qfrc_applied xfrc_applied mocap_pos mocap_quat history".split()
OUTPUTS = (
    "sensordata cacc cfrc_int cfrc_ext subtree_linvel subtree_angmom energy cam_xpos cam_xmat light_xpos light_xdir"
).split()
# What the compiler gives cameras and lights, which the test puts into the model: tests of the compiler compare it.
OPTICS = (
    "cam_mode cam_bodyid cam_targetbodyid cam_pos cam_quat cam_projection cam_fovy cam_resolution cam_sensorsize "
    "cam_intrinsic light_mode light_bodyid light_targetbodyid light_pos light_dir"
).split()
CONSTANTS = "nhistory cam_pos0 cam_poscom0 cam_mat0 light_pos0 light_poscom0 light_dir0".split()


def line(name, value):
    flat = np.asarray(value).ravel().tolist()
    return " ".join([name, *(repr(int(x)) if isinstance(x, (bool, int)) else repr(float(x)) for x in flat)])


def record(path):
    m = mujoco.MjModel.from_xml_path(str(path))
    d = mujoco.MjData(m)
    rng = np.random.default_rng(7)
    sensors = [f for f in dir(m) if f.startswith("sensor_") and f != "sensor_plugin"]
    lines = [line(f"model.{f}", getattr(m, f)) for f in OPTICS + CONSTANTS + sensors]
    # Contacts stay where they are: states differ by little.
    scale = 3e-4 if "contacts" in path.name else 0.3
    # Delayed sensors leave the rest of what they need to the end of a step; energy is not the business of constraints.
    outputs = OUTPUTS[:1] if m.nhistory else OUTPUTS[:4] if m.neq else OUTPUTS
    for state in range(STATES):
        mujoco.mj_resetData(m, d)
        if state:
            d.time = 0.5 * state
            mujoco.mj_integratePos(m, d.qpos, scale * rng.normal(size=m.nv), 1)
            d.qvel[:] = scale * rng.normal(size=m.nv) * 3
            d.act[:] = rng.uniform(size=m.na)
            d.ctrl[:] = rng.uniform(-1, 1, size=m.nu)
            d.qfrc_applied[:] = rng.normal(size=m.nv)
            d.xfrc_applied[1:] = rng.normal(size=(m.nbody - 1, 6))
            d.mocap_pos[:] += 0.1 * rng.normal(size=(m.nmocap, 3))
            d.mocap_quat[:] = rng.normal(size=(m.nmocap, 4))
        lines.append("state")
        lines += [line(f, getattr(d, f)) for f in INPUTS]
        mujoco.mj_forward(m, d)
        if m.neq:
            # Forces of constraints, which the test puts into the data.
            lines += [line(f"rows.{f}", getattr(d, f)) for f in "qacc efc_type efc_id efc_force".split()]
        lines += [line(f, getattr(d, f)) for f in outputs]
        if m.nhistory and state in (0, 1):
            for _ in range(STEPS):
                mujoco.mj_step(m, d)
                lines += ["step", line("qpos", d.qpos), line("sensordata", d.sensordata), line("history", d.history)]
    path.with_suffix(".txt").write_text("\n".join(lines) + "\n")


for xml in sorted(HERE.glob("*.xml")):
    record(xml)
