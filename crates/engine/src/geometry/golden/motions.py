"""Contacts that MuJoCo 3.14.0 finds along motions of boxes, capsules and cylinders: `python motions.py FOLDER` with mujoco==3.14.0.

Stacks of equal boxes, stacks of other boxes with offsets, heaps of boxes, heaps of boxes, capsules and cylinders: every twentieth of
3,000 steps. Writes pairs.txt as `record.py` does, whose meshes and ground it takes over.
"""

import pathlib
import sys

import mujoco
import numpy as np

KINDS = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"]
FOLDER = pathlib.Path(sys.argv[1])
HERE = pathlib.Path(__file__).parent
rng = np.random.default_rng(1)
between = rng.uniform


def words(values):
    return " ".join(repr(float(x)) for x in np.ravel(values))


def short(values):
    return " ".join(f"{float(x):.14g}" for x in np.ravel(values))


def body(kind, pos, euler, size):
    return f"<body pos='{words(pos)}' euler='{words(euler)}'><freejoint/><geom type='{kind}' size='{words(size)}'/></body>"


def scene(name):
    if name == "stack":
        bodies = [body("box", (0, 0, 0.1 + 0.2001 * i), (0, 0, 0), [0.1] * 3) for i in range(5)]
    elif name == "offsets":
        turn = lambda: between(-40, 40) if rng.random() < 0.5 else 0
        bodies = [
            body("box", (between(-0.04, 0.04), between(-0.04, 0.04), 0.05 + 0.1005 * i), (0, 0, turn()), (between(0.08, 0.15), between(0.08, 0.15), 0.05))
            for i in range(5)
        ]
    else:
        kinds = ["box"] if name == "boxes" else ["box", "capsule", "cylinder", "box"]
        bodies = [
            body(
                kinds[i % len(kinds)],
                (between(-0.1, 0.1), between(-0.1, 0.1), 0.2 + 0.25 * i),
                (between(-180, 180), between(-90, 90), 0),
                (between(0.04, 0.15 if name == "boxes" else 0.1), between(0.05, 0.15), between(0.05, 0.15)),
            )
            for i in range(8)
        ]
        for x, y, angle in [(0, 0.35, 0), (0, -0.35, 0), (0.35, 0, 90), (-0.35, 0, 90)]:
            bodies.append(f"<geom type='box' size='.5 .05 .5' pos='{x} {y} .5' euler='0 0 {angle}'/>")
    floor = "<geom type='box' size='2 2 .1' pos='0 0 -.1'/>" if rng.random() < 0.5 else "<geom type='plane' size='0 0 1'/>"
    return f"<mujoco><worldbody>{floor}{''.join(bodies)}</worldbody></mujoco>"


def shape(m, d, g):
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, d.geom_xmat[g])
    return f"{KINDS[m.geom_type[g]]} - {words(m.geom_size[g])} {words(d.geom_xpos[g])} {words(quat)}"


def near(m, d):
    """Pairs that touch, with their contacts, and a fifth of those that only might."""
    found = {}
    for c in d.contact[: d.ncon]:
        found.setdefault(tuple(c.geom), []).append([c.dist, *c.pos, *c.frame[:6]])
    for a in range(m.ngeom):
        for b in range(a + 1, m.ngeom):
            apart = np.linalg.norm(d.geom_xpos[a] - d.geom_xpos[b]) > m.geom_rbound[a] + m.geom_rbound[b]
            same = m.geom_bodyid[a] == m.geom_bodyid[b]
            known = (a, b) in found or (b, a) in found or m.geom_type[a] > m.geom_type[b]
            if not (apart or same or known) and m.geom_rbound[a] > 0 and rng.random() < 0.2:
                found[a, b] = []
    return found


lines = [l for l in (HERE / "pairs.txt").read_text().splitlines() if l.startswith(("mesh ", "field "))]
for name in ["stack"] + 8 * ["offsets"] + 8 * ["boxes"] + 8 * ["all"]:
    m = mujoco.MjModel.from_xml_string(scene(name))
    d = mujoco.MjData(m)
    for step in range(3000):
        mujoco.mj_step(m, d)
        if step % 20:
            continue
        mujoco.mj_kinematics(m, d)
        mujoco.mj_comPos(m, d)
        mujoco.mj_collision(m, d)
        for (a, b), contacts in near(m, d).items():
            # Only closed forms: cylinders with capsules and boxes are searched for.
            if KINDS[m.geom_type[a]] != "cylinder" and (m.geom_type[a], m.geom_type[b]) != (3, 5):
                lines.append(f"contact {shape(m, d, a)} {shape(m, d, b)} 0.0 | {short(contacts)}".rstrip())
(FOLDER / "pairs.txt").write_text("\n".join(lines) + "\n")
