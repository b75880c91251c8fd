#!/usr/bin/env python3
"""What MuJoCo 3.14.0 makes of random settings of the labs in ../twenty/labs.md: the reference of tests/twenty.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python twenty.py 6000 > twenty.json        # so many settings: 13 minutes on two processors (JOBS)

Every setting is run in the library as the lab has it, and once more with steps of the fourth order that are much shorter: that is
what the model describes. A setting is broken where the library warns of numbers that are none, where anything moves with four times the
energy that it has in the reference or that springs and servos hold at the start, where a joint is beyond its limit by half its range, where a ball is outside its walls, and where boxes
stay in each other by half their size; sound where none of this is so, nor by a quarter of it, the largest energy is that of the reference to three tenths and what
the lab shows is off by a twentieth of its range at most (in labs without a closed course, energy alone); and neither between the two.
"""
import json
import math
import os
import random
import re
import sys
import types
from concurrent.futures import ProcessPoolExecutor

import mujoco
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SEED = 77
SHORT = 1e-4
CHAOTIC = {"Double pendulum", "Pinball", "Spring pendulum", "Long chain"}
WALLS = {"Ball between walls": [1.02], "Pinball": [0.85, 0.95]}
BAD = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]


def labs():
    text = open(os.path.join(HERE, "../twenty/labs.md")).read()
    return [json.loads(block) for block in re.findall(r"```lab simlab\n(.*?)```", text, re.S)]


class Flat:
    """A model or data whose fields are lists of numbers, as in JavaScript."""

    def __init__(self, of):
        self.of = of

    def __getattr__(self, name):
        value = getattr(self.of, name)
        return value.reshape(-1) if isinstance(value, np.ndarray) else value


MJ = types.SimpleNamespace(mj_setConst=lambda model, data: mujoco.mj_setConst(model.of, data.of))


class Lab:
    """A lab as a page loads it: its statements mean the same in Python."""

    def __init__(self, lab, settings, timestep=None, integrator=None):
        self.model = mujoco.MjModel.from_xml_string(lab["xml"])
        self.data = mujoco.MjData(self.model)
        self.ctx = types.SimpleNamespace()
        mujoco.mj_forward(self.model, self.data)
        self.state = {c["label"]: c["value"] for c in lab["controls"]}
        codes = {c["label"]: self.code(self.text(c)) for c in lab["controls"]}
        setup = self.code(lab.get("setup", ""))
        again = [c for c in lab["controls"] if c.get("init")]

        def put(control, value):
            self.state[control["label"]] = value
            if "param" in control:
                setattr(self.ctx, control["param"], value)
            self.do(codes[control["label"]], value)

        def reapply():
            self.do(setup)
            for control in again:
                self.do(codes[control["label"]], self.state[control["label"]])

        for control in lab["controls"]:
            put(control, control["value"])
        reapply()
        mujoco.mj_forward(self.model, self.data)
        for control in lab["controls"]:
            if control["label"] in settings:
                put(control, settings[control["label"]])
                if control.get("reset"):
                    mujoco.mj_resetData(self.model, self.data)
                    mujoco.mj_forward(self.model, self.data)
                    reapply()
                mujoco.mj_forward(self.model, self.data)
        self.controller = self.code(lab["controller"]) if "controller" in lab else None
        self.shown = [compile(r["expr"], "shown", "eval") for r in lab["readouts"]]
        if timestep:
            self.model.opt.timestep = timestep
        if integrator is not None:
            self.model.opt.integrator = integrator

    def code(self, text):
        return compile("\n".join(part.strip() for part in text.split(";") if part.strip()), "lab", "exec")

    def names(self, value=None):
        return {
            "model": Flat(self.model),
            "data": Flat(self.data),
            "mj": MJ,
            "ctx": self.ctx,
            "Math": math,
            "value": value,
        }

    def do(self, code, value=None):
        exec(code, self.names(value))

    @staticmethod
    def text(control):
        return control.get("apply") or (f"{control['set']} = value" if "set" in control else "")

    def show(self):
        names = self.names()
        return [float(eval(code, names)) for code in self.shown]

    def step(self, n):
        if self.controller is None:
            mujoco.mj_step(self.model, self.data, n)
        else:
            for _ in range(n):
                self.do(self.controller)
                mujoco.mj_step(self.model, self.data)

    def kinetic(self):
        product = np.zeros(self.model.nv)
        mujoco.mj_mulM(self.model, self.data, product, self.data.qvel)
        return 0.5 * float(product @ self.data.qvel)

    def stored(self):
        """What springs of joints and servos hold, J."""
        m, d, total = self.model, self.data, 0.0
        for j in range(m.njnt):
            if m.jnt_type[j] >= 2:
                q = m.jnt_qposadr[j]
                total += 0.5 * m.jnt_stiffness[j] * (d.qpos[q] - m.qpos_spring[q]) ** 2
        for a in range(m.nu):
            kp = -m.actuator_biasprm[a, 1]
            if kp > 0:
                total += 0.5 * kp * (d.actuator_length[a] - m.actuator_gainprm[a, 0] * d.ctrl[a] / kp) ** 2
        return float(total)

    def bad(self):
        return any(self.data.warning[int(w)].number for w in BAD)


def deep(lab):
    """How deep boxes are in each other, m."""
    contacts = lab.data.contact
    return max((-c.dist for c in contacts), default=0.0)


def outside(title, lab):
    limits = WALLS.get(title)
    ball = lab.data.xpos[lab.model.nbody - 1]
    return limits is not None and any(abs(x) > limit for x, limit in zip(ball, limits))


def beyond(lab):
    """How far a joint is beyond its limit, in parts of its range."""
    m, most = lab.model, 0.0
    for j in range(m.njnt):
        if m.jnt_limited[j]:
            low, high = m.jnt_range[j]
            q = lab.data.qpos[m.jnt_qposadr[j]]
            most = max(most, max(low - q, q - high) / (high - low))
    return most


def run(title, lab, stop, every, watch):
    """Largest energy, samples, and what is wrong."""
    h = lab.model.opt.timestep
    steps = round(stop / h)
    peak, rows, since, wrong, most = lab.kinetic(), [lab.show()], None, None, 0.0
    for k in range(0, steps, every):
        lab.step(min(every, steps - k))
        if lab.bad() or not np.isfinite(lab.data.qpos).all():
            return math.inf, rows, "warning", most
        peak = max(peak, lab.kinetic())
        rows.append(lab.show())
        if watch and wrong is None:
            if outside(title, lab):
                wrong = "outside its walls"
            elif beyond(lab) > 0.5:
                wrong = "past its limit"
            elif title in ("Mass ratio", "Stack"):
                depth = deep(lab)
                most = max(most, depth)
                since = (lab.data.time if since is None else since) if depth > 0.1 else None
                if since is not None and lab.data.time - since >= 0.25:
                    wrong = "sunk"
    return peak, rows, wrong, most


def judge(args):
    number, lab, settings = args
    title, stop = lab["title"], lab["stopAt"]
    own = Lab(lab, settings)
    h = own.model.opt.timestep
    extent = own.model.stat.extent
    weight = float(own.model.body_mass.sum() * np.linalg.norm(own.model.opt.gravity))
    stored = own.stored()
    peak, rows, wrong, pressed = run(title, own, stop, 1, True)
    parts = max(round(h / SHORT), 10)
    exact = Lab(lab, settings, h / parts, mujoco.mjtIntegrator.mjINT_RK4)
    # Contacts keep the time constant that the longer step gives them.
    for solref in (exact.model.geom_solref, exact.model.jnt_solref, exact.model.eq_solref):
        positive = solref[:, 0] > 0
        solref[positive, 0] = np.maximum(solref[positive, 0], 2 * h)
    true, truth, none, _ = run(title, exact, stop, parts, False)
    out = {"lab": number, "set": settings, "broken": None, "why": ""}
    if none:
        out["why"] = "the reference breaks"
        return out
    scale = true + 0.1 * weight * extent + 1e-12
    if wrong:
        out.update(broken=True, why=wrong)
    elif peak > 4 * (scale + stored):
        out.update(broken=True, why=f"energy {peak / scale:.3g}")
    else:
        a, b = np.array(rows), np.array(truth)
        n = min(len(a), len(b))
        span = np.maximum(np.ptp(b, axis=0), 1e-6)
        off = float((np.abs(a[:n] - b[:n]).max(axis=0) / span).max())
        if peak <= 1.3 * scale and pressed <= 0.05 and (off <= 0.05 or title in CHAOTIC):
            out.update(broken=False, why=f"off {off:.3g}")
        else:
            out["why"] = f"off {off:.3g}, energy {peak / scale:.3g}"
    return out


def setting(control, dice):
    if control.get("type") == "select":
        return dice.choice(control["options"])[1]
    low, high, step = control["min"], control["max"], control["step"]
    if low > 0 and high / low >= 50:
        value = math.exp(dice.uniform(math.log(low), math.log(high)))
    else:
        value = dice.uniform(low, high)
    value = low + round((value - low) / step) * step
    return float(f"{min(value, high):.9g}")


def main():
    many, all_labs, dice = int(sys.argv[1]), labs(), random.Random(SEED)
    jobs = []
    for k in range(many):
        number = k % len(all_labs)
        lab = all_labs[number]
        jobs.append((number, lab, {c["label"]: setting(c, dice) for c in lab["controls"]}))
    with ProcessPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        found = list(pool.map(judge, jobs, chunksize=8))
    lines = ",\n".join(" " + json.dumps(x) for x in found)
    print(f'{{"version": "{mujoco.__version__}", "seed": {SEED}, "settings": [\n{lines}\n]}}')


main()
