"""What MuJoCo 3.14.0 does with contact bits that are switched while it runs, and with sizes and margins.

    pip install mujoco==3.14.0
    python tests/golden/switched.py > tests/golden/switched.txt

A box falls onto a floor. After 50 steps some numbers of the model are written, and after 1,000 the height of the box is noted: near
0.1 m where it lies on the floor, far below where it fell through. A line: name | writes | height, m | model.
"""

import itertools

import mujoco

OFF = "contype='0' conaffinity='0'"


def model(floor="", box="", more="", world="", flags=""):
    return (
        f"<mujoco><option timestep='0.002'>{flags}</option><worldbody>"
        f"<geom name='floor' type='plane' size='2 2 1' {floor}/>{world}<body name='b' pos='0 0 0.5'><freejoint/>"
        f"<geom name='box' type='box' size='.1 .1 .1' {box}/>{more}</body></worldbody></mujoco>"
    )


def height(xml, writes):
    m = mujoco.MjModel.from_xml_string(xml)
    d = mujoco.MjData(m)
    for step in range(1000):
        if step == 50:
            for field, index, value in writes:
                getattr(m, field)[index] = value
        mujoco.mj_step(m, d)
    return d.qpos[2]


def bits(switched, body=True, world=1):
    """The floor and the box are switched on, and their bodies."""
    box = world
    writes = [(f"geom_{kind}", geom, 1) for geom in (0, box) for kind in ("contype", "conaffinity")]
    bodies = [(f"body_{kind}", b, 1) for b in (0, 1) for kind in ("contype", "conaffinity")]
    return (writes if switched else []) + (bodies if body else [])


def cases():
    on = ("geom_contype", 1, 1)
    yield "on from the start", model(), []
    yield "off", model(box=OFF), []
    yield "contype of the box alone", model(box=OFF), [on]
    yield "conaffinity of the box alone", model(box=OFF), [("geom_conaffinity", 1, 1)]
    yield "contype of the box and its body", model(box=OFF), [on, ("body_contype", 1, 1)]
    yield "contype of the box, conaffinity of its body", model(box=OFF), [on, ("body_conaffinity", 1, 1)]
    yield "contype of the body alone", model(box=OFF), [("body_contype", 1, 1)]
    yield "contype of the floor alone", model(floor=OFF), [("geom_contype", 0, 1)]
    yield "contype of the floor and the world", model(floor=OFF), [("geom_contype", 0, 1), ("body_contype", 0, 1)]
    yield "the box is switched off", model(), [("geom_contype", 1, 0), ("geom_conaffinity", 1, 0)]
    yield "the body is switched off", model(), [("body_contype", 1, 0), ("body_conaffinity", 1, 0)]
    yield "half of the body is switched off", model(), [("body_contype", 1, 0)]
    two = "contype='2' conaffinity='2'"
    yield "another bit, of the floor", model(floor=two), [("geom_contype", 1, 2)]
    yield "another bit, of the box", model(floor="contype='3' conaffinity='3'", box="conaffinity='0'"), [("geom_contype", 1, 2)]
    yield "margin", model(), [("geom_margin", 1, 0.05)]
    yield "margin and that of the body", model(), [("geom_margin", 1, 0.05), ("body_margin", 1, 0.05)]
    # Bodies of several geoms have trees of bounding volumes.
    states = (None, "on", "off")
    for floor, world, box, more in itertools.product(("on", "off"), states, ("on", "off"), states):
        text = lambda state: "" if state == "on" else OFF
        geom = lambda state, name, at: "" if state is None else f"<geom name='{name}' size='.02' pos='{at}' {text(state)}/>"
        parts = dict(floor=text(floor), box=text(box), world=geom(world, "w", "5 5 5"), more=geom(more, "h", "0 0 .2"))
        for name, flags in (("", ""), (", no midphase", "<flag midphase='disable'/>")):
            what = f"floor {floor}, world {world or 'alone'}, box {box}, body {more or 'alone'}{name}"
            count = 1 if world is None else 2
            yield what, model(**parts, flags=flags), bits(True, world=count)
            if not flags:
                yield what + ", geoms alone", model(**parts), bits(True, body=False, world=count)


for name, xml, writes in cases():
    words = "; ".join(f"{field} {index} {value}" for field, index, value in writes)
    print(f"{name} | {words} | {height(xml, writes):.6f} | {xml}")
