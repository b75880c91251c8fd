"""Records what MuJoCo 3.14.0 finds for random shapes: `python record.py [N [FOLDER]]` with mujoco==3.14.0.

Penetrations of every depth, and a quarter of the pairs grazing: within 1e-7 to 1e-2 of touching.
Writes rays.txt and pairs.txt with N cases (default: the few of the repository) of each type or pair of types. Lines:
    mesh NAME vertices | triangles | hull graph
    field NAME rows columns size | samples
    ray SHAPE from along | distance normal
    distance SHAPE SHAPE largest | distance fromto
    contact SHAPE SHAPE margin | for each contact: distance, position, frame
where SHAPE is type, data (a name or -), size, position, quaternion.
"""

import functools
import pathlib
import sys

import mujoco
import numpy as np

N = int(sys.argv[1]) if len(sys.argv) > 1 else 0
HERE = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(__file__).parent
KINDS = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"]
MESHES = {
    "wedge": [(0, 0, 0), (0.6, 0, 0), (0, 0.5, 0), (0, 0, 0.4)],
    "prism": [(x, y, z) for z in (-0.2, 0.3) for x, y in [(0.4, 0), (0.1, 0.35), (-0.3, 0.2), (-0.3, -0.2), (0.1, -0.35)]],
    "stone": np.random.default_rng(1).normal(size=(30, 3)).round(3) * 0.2,
}
FIELD = np.random.default_rng(2).uniform(size=(5, 7)).round(2)
rng = np.random.default_rng(3)


@functools.cache
def scene(kind1, kind2, mesh):
    """Two free bodies with a geom each, and their data; poses and sizes are written later."""
    vertices = " ".join(str(x) for v in MESHES[mesh] for x in v)
    ground = " ".join(str(x) for x in FIELD.flatten())
    body = lambda k, i: {
        "plane": "<body><geom type='plane' size='0 0 1'/></body>",
        "hfield": "<body><geom type='hfield' hfield='ground'/></body>",
        "mesh": f"<body><freejoint/><geom type='mesh' mesh='{mesh}'/></body>",
    }.get(k, f"<body><freejoint/><geom type='{k}' size='1 1 1'/></body>")
    m = mujoco.MjModel.from_xml_string(
        # Closer than the default: what is compared is the answer, not where a search stops. (With 150 iterations and more,
        # or a tolerance of 1e-12, the library crashes on some of these pairs.)
        f"<mujoco><option ccd_tolerance='1e-9' ccd_iterations='100'/><asset><mesh name='{mesh}' vertex='{vertices}'/>"
        f"<hfield name='ground' nrow='5' ncol='7' size='1.2 0.9 0.5 0.3' elevation='{ground}'/></asset>"
        f"<worldbody>{body(kind1, 1)}{body(kind2, 2)}</worldbody></mujoco>"
    )
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    return m, d


def numbers(values):
    return " ".join(repr(float(x)) if not isinstance(x, (int, np.integer)) else str(x) for x in np.ravel(values))


def short(values):
    return " ".join(f"{float(x):.14g}" for x in np.ravel(values))


def random_quat():
    if rng.random() < 0.25:
        # Aligned with the world, or turned by a right angle.
        return np.array([(1, 0, 0, 0), (1, 1, 0, 0), (1, 0, 1, 0), (1, 0, 0, 1), (0, 1, 0, 0)][rng.integers(5)], float)
    return rng.normal(size=4).round(3)


def rbound(kind, size):
    x, y, z = size
    return {
        "plane": 0, "sphere": x, "capsule": x + y, "cylinder": np.hypot(x, y), "ellipsoid": max(size),
        "box": np.linalg.norm(size),
    }[kind]


def place(m, d, g, kind, mesh, scale, pos):
    """Gives geom `g` a size and a pose; the words that say so."""
    if kind not in ("mesh", "hfield"):
        size = (rng.uniform(0.05, 0.6, size=3) * scale).round(3 if scale >= 1 else 6)
        if kind == "plane":
            size = np.array([0, 0, 1.0])
        m.geom_size[g] = size
        m.geom_rbound[g] = rbound(kind, size)
        if kind != "plane":
            m.geom_aabb[g] = m.bvh_aabb[m.body_bvhadr[m.geom_bodyid[g]]] = [0, 0, 0] + [m.geom_rbound[g]] * 3
    quat = random_quat()
    unit, mat = quat.copy(), np.zeros(9)
    mujoco.mju_normalize4(unit)
    mujoco.mju_quat2Mat(mat, unit)
    d.geom_xpos[g], d.geom_xmat[g] = pos, mat
    data = {"mesh": mesh, "hfield": "ground"}.get(kind, "-")
    return f"{kind} {data} {numbers(m.geom_size[g])} {numbers(pos)} {numbers(quat)}"


def graze(m, d, words, scale):
    """Moves the second geom so that the two hardly touch or hardly do not; its words with the new position."""
    fromto = np.zeros(6)
    x = mujoco.mj_geomDistance(m, d, 0, 1, 1e3, fromto)
    along = (fromto[3:] - fromto[:3]) * np.sign(x)
    if not 1e-9 < np.linalg.norm(along) < 1e2:
        return words
    target = scale * rng.choice([-1, 1]) * 10 ** rng.uniform(-7, -2)
    moved = d.geom_xpos[1] + along / np.linalg.norm(along) * (target - x)
    d.geom_xpos[1] = moved.round(9)
    words = words.split(" ")
    words[5:8] = numbers(d.geom_xpos[1]).split(" ")
    return " ".join(words)


def assets():
    lines = []
    for name in MESHES:
        m, _ = scene("sphere", "mesh", name)
        faces = m.mesh_face.flatten().tolist()
        lines.append(f"mesh {name} {numbers(m.mesh_vert)} | {numbers(faces)} | {numbers(m.mesh_graph.tolist())}")
    m, _ = scene("hfield", "sphere", "wedge")
    lines.append(f"field ground 5 7 {numbers(m.hfield_size)} | {numbers(m.hfield_data)}")
    return lines


def rays(count):
    lines = assets()
    for kind in KINDS:
        for i in range(count):
            mesh = list(MESHES)[i % len(MESHES)]
            m, d = scene(kind, "sphere", mesh)
            d.geom_xpos[1] = [0, 0, 1e6]
            shape = place(m, d, 0, kind, mesh, 1.0, rng.uniform(-0.3, 0.3, size=3).round(3))
            if kind == "plane":
                m.geom_size[0] = [rng.integers(2), rng.integers(3) / 2, 1]
                words = shape.split(" ")
                words[2:5] = numbers(m.geom_size[0]).split(" ")
                shape = " ".join(words)
            start = rng.uniform(-1.5, 1.5, size=3).round(3) * rng.choice([0.1, 1.0])
            along = (rng.uniform(-0.4, 0.4, size=3) - start).round(3) if rng.random() < 0.8 else rng.normal(size=3).round(3)
            if rng.random() < 0.2:
                along = np.eye(3)[rng.integers(3)] * rng.choice([-1, 1])
            geom, normal = np.zeros(1, np.int32), np.zeros(3)
            x = mujoco.mj_ray(m, d, start, along, None, True, int(m.geom_bodyid[1]), geom, normal)
            lines.append(f"ray {shape} {numbers(start)} {numbers(along)} | {short([x, *normal])}")
    (HERE / "rays.txt").write_text("\n".join(lines) + "\n")


def pairs(count):
    lines = assets()
    for i1, kind1 in enumerate(KINDS):
        for kind2 in KINDS[max(i1, 2):]:
            for i in range(count):
                mesh = list(MESHES)[i % len(MESHES)]
                m, d = scene(kind1, kind2, mesh)
                scale = rng.choice([1, 1, 1, 1, 1, 1, 1, 1, 1e-2, 1e2]) if "mesh" not in (kind1, kind2) and kind1 != "hfield" else 1
                pos1 = rng.uniform(-0.2, 0.2, size=3).round(3)
                a = place(m, d, 0, kind1, mesh, scale, pos1)
                reach = (m.geom_rbound[0] if kind1 not in ("plane", "hfield") else 0.8) + m.geom_rbound[1]
                away = rng.normal(size=3)
                away *= 0 if rng.random() < 0.02 else rng.uniform(0, 1.2) * reach / np.linalg.norm(away)
                b = place(m, d, 1, kind2, mesh, scale, (pos1 + away).round(4 if scale >= 1 else 7))
                if rng.random() < 0.25 and kind1 != "hfield":
                    b = graze(m, d, b, scale)
                most = float(rng.choice([0, 0.1, 5, 1000]))
                fromto = np.zeros(6)
                g1, g2 = (0, 1) if rng.random() < 0.7 else (1, 0)
                x = mujoco.mj_geomDistance(m, d, g1, g2, most, fromto)
                first, second = (a, b) if g1 == 0 else (b, a)
                lines.append(f"distance {first} {second} {most} | {short([x, *fromto])}")
                margin = float(rng.choice([0, 0, 0.01 * scale, 0.2 * scale]))
                m.geom_margin[:] = [margin, 0]
                m.body_margin[:] = [0, margin, 0]
                mujoco.mj_collision(m, d)
                found = [[c.dist, *c.pos, *c.frame[:6]] for c in d.contact[: d.ncon]]
                lines.append(f"contact {a} {b} {margin} | {short(found)}".rstrip())
    (HERE / "pairs.txt").write_text("\n".join(lines) + "\n")


rays(N or 16)
pairs(N or 40)
