"""Records the states of `everything.xml` in MuJoCo 3.14.0: `python record.py` with mujoco==3.14.0 and numpy.

Writes everything.txt: a line `set` with all numbers of an integration state, then a line `SIGNATURE numbers…` for each of
many signatures; a line `step` with the state after ten steps from there; lines `key_FIELD` after that state became
keyframe 1, and a line `reset` with the state after a reset to keyframe 0.
"""

import pathlib

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
STATE = mujoco.mjtState
ALL = int(STATE.mjSTATE_INTEGRATION)


def state(m, d, sig):
    out = np.zeros(mujoco.mj_stateSize(m, sig))
    mujoco.mj_getState(m, d, out, sig)
    return out


def line(name, numbers):
    return " ".join([str(name)] + [repr(float(x)) for x in np.ravel(numbers)])


def main():
    m = mujoco.MjModel.from_xml_path(str(HERE / "everything.xml"))
    d = mujoco.MjData(m)
    rng = np.random.default_rng(1)
    wild = state(m, d, ALL)
    head = mujoco.mj_stateSize(m, 0b11111)
    history = slice(mujoco.mj_stateSize(m, 0b1111), head)
    keep = wild[history].copy()
    wild = rng.normal(size=wild.size)
    wild[history] = keep
    flags = mujoco.mj_stateSize(m, (1 << 9) - 1)
    wild[flags : flags + m.neq] = [0, 1]
    mujoco.mj_setState(m, d, wild, ALL)
    lines = [line("set", wild)]
    signatures = [1 << k for k in range(14)] + [int(STATE.mjSTATE_PHYSICS), int(STATE.mjSTATE_FULLPHYSICS), int(STATE.mjSTATE_USER), ALL]
    signatures += [int(x) for x in rng.integers(0, 1 << 14, 20)]
    lines += [line(sig, state(m, d, sig)) for sig in signatures]
    for _ in range(10):
        mujoco.mj_step(m, d)
    lines.append(line("step", state(m, d, ALL)))
    mujoco.mj_setKeyframe(m, d, 1)
    lines += [line(name, getattr(m, name)) for name in "key_time key_qpos key_qvel key_act key_ctrl key_mpos key_mquat".split()]
    mujoco.mj_resetDataKeyframe(m, d, 0)
    lines.append(line("reset", state(m, d, ALL)))
    (HERE / "everything.txt").write_text("\n".join(lines) + "\n")


main()
