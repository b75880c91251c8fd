#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for small models that are written here: the reference of crates/core/tests/library.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python tests/golden/library_cases.py

Writes library_cases.txt: for each case a line `case NAME`, the model in one line, then fields with their numbers.
"""
import pathlib

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
MODEL = "body_simple dof_M0 body_invweight0 dof_invweight0 tendon_invweight0 actuator_acc0".split()
DATA = "actuator_length actuator_velocity sensordata qacc efc_aref efc_D efc_force".split()

HUNG = """<mujoco><worldbody><site name="w" pos="0.3 0.1 1"/><body pos="0 0 .2">%s<geom type="box" size=".1 .1 .1" mass="4.18879"/>
<site name="s" pos=".1 .05 .1"/></body></worldbody><tendon>%s</tendon>%s</mujoco>"""
FREE, SLIDE, TWO = "<freejoint/>", '<joint name="j" type="slide" axis="1 0 0"/>', '<joint name="j" type="slide" axis="1 0 0"/><joint name="k" type="slide" axis="0 1 0"/>'
PATH = '<spatial name="t"%s><site site="w"/><site site="s"/></spatial>'
FIXED = '<fixed name="t"%s><joint joint="j" coef="2"/></fixed>'
ROTOR = '<actuator><motor tendon="t" armature="0.5"/></actuator>'
HEAVY = ' armature="0.5"'

PAIR = '<mujoco>%s<worldbody>%s</worldbody><contact><pair geom1="a" geom2="b"%s/></contact></mujoco>'
A, B = '<geom name="a" size=".1"/>', '<geom name="b" size=".1" pos=".15 0 0"/>'
MOVING = '<body pos="5 5 5"><freejoint/><geom size=".1"/></body>'
SPARSE, ELLIPTIC = '<option jacobian="sparse"/>', '<option cone="elliptic"/>'


def body(inside, joint=""):
    return f"<body>{joint}{inside}</body>"


CASES = {
    "rotor_free": HUNG % (FREE, PATH % "", ROTOR),
    "tendon_free": HUNG % (FREE, PATH % HEAVY, ""),
    "both_free": HUNG % (FREE, PATH % HEAVY, ROTOR),
    "rotor_slide": HUNG % (SLIDE, PATH % "", ROTOR),
    "rotor_slide_fixed": HUNG % (SLIDE, FIXED % "", ROTOR),
    "tendon_slide_fixed": HUNG % (SLIDE, FIXED % HEAVY, ""),
    "rotor_two_slides": HUNG % (TWO, PATH % "", ROTOR),
    "pair_of_world": PAIR % ("", A + B, ""),
    "pair_of_world_with_body": PAIR % ("", A + B + "<body/>", ""),
    "pair_of_static_bodies": PAIR % ("", body(A) + body(B), ""),
    "pair_of_static_body": PAIR % ("", body(A + B), ""),
    "pair_of_static_and_world": PAIR % ("", body(A) + B, ""),
    "pair_of_world_sparse": PAIR % (SPARSE, A + B + MOVING, ""),
    "pair_of_static_bodies_sparse": PAIR % (SPARSE, body(A) + body(B) + MOVING, ""),
    "pair_of_mocap_and_world_sparse": PAIR % (SPARSE, f'<body mocap="true">{A}</body>' + B + MOVING, ""),
    "pair_of_one_body": PAIR % ("", body(A + B, FREE), ""),
    "pair_of_one_body_frictionless": PAIR % ("", body(A + B, FREE), ' condim="1"'),
    "pair_of_one_body_rolling": PAIR % ("", body(A + B, FREE), ' condim="6"'),
    "pair_of_one_body_elliptic": PAIR % (ELLIPTIC, body(A + B, FREE), ""),
    "pair_of_one_body_hinge": PAIR % ("", body(A + B, "<joint/>"), ""),
    "pair_of_one_body_sparse": PAIR % (SPARSE, body(A + B, FREE), ""),
    "pair_of_welded_bodies": PAIR % ("", body(A + body(B), FREE) + MOVING, ""),
    "pair_of_parent_and_child": PAIR % ("", body(A + body(B, "<joint/>"), FREE) + MOVING, ""),
}


def text(a):
    return " ".join(repr(float(x)) for x in np.asarray(a, dtype=float).ravel())


def record(xml):
    m = mujoco.MjModel.from_xml_string(xml)
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    out = [f"model.{f} {text(getattr(m, f))}" for f in MODEL if np.size(getattr(m, f))]
    if m.nv:
        full = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, full)
        out.append(f"full_m {text(full)}")
    out += [f"nefc {d.nefc}"]
    for key in ("dist", "efc_address", "exclude"):
        out.append(f"contact.{key} {text([getattr(c, key) for c in d.contact[:d.ncon]])}".rstrip())
    out += [f"data.{f} {text(getattr(d, f))}" for f in DATA if np.size(getattr(d, f))]
    return out


lines = []
for name, xml in CASES.items():
    lines += [f"case {name}", " ".join(xml.split()), *record(xml)]
(HERE / "library_cases.txt").write_text("\n".join(lines) + "\n")
