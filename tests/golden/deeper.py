#!/usr/bin/env python3
"""Where contacts differ from MuJoCo's: how deep the two bodies are in each other along each side's normal.

    tests/golden/deeper.py LABSPEC ORACLE MODEL.xml ...          pair by pair, then a table of the models

ORACLE is the folder of `mj_record.py`. The depth along a direction is the sum of two supports: the farthest corner of a mesh,
or a formula. It owes nothing to either search; the least depth over all directions is the one that a contact should have, so
that of two normals the one with the smaller depth is the better. Needs mujoco==3.14.0 and numpy.
"""
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

import mujoco
import numpy as np

SAME = 1e-6


def support(model, data, geom, direction):
    """The largest coordinate of a geom along a direction; None for one without a formula here."""
    frame, size, middle = data.geom_xmat[geom].reshape(3, 3), model.geom_size[geom], data.geom_xpos[geom] @ direction
    local = frame.T @ direction
    kind = mujoco.mjtGeom(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        return middle + (model.mesh_vert[first:first + model.mesh_vertnum[mesh]].astype(float) @ local).max()
    reach = {
        mujoco.mjtGeom.mjGEOM_SPHERE: lambda: size[0],
        mujoco.mjtGeom.mjGEOM_CAPSULE: lambda: size[0] + size[1] * abs(local[2]),
        mujoco.mjtGeom.mjGEOM_ELLIPSOID: lambda: np.linalg.norm(size * local),
        mujoco.mjtGeom.mjGEOM_CYLINDER: lambda: size[1] * abs(local[2]) + size[0] * np.hypot(local[0], local[1]),
        mujoco.mjtGeom.mjGEOM_BOX: lambda: size @ abs(local),
    }.get(kind)
    return reach and middle + reach()


def depth(model, data, pair, normal):
    a, b = support(model, data, pair[0], normal), support(model, data, pair[1], -normal)
    return None if a is None or b is None else a + b


def least(model, data, pair, contacts):
    """The smallest depth along the normals of a pair's contacts, which need not be one."""
    depths = [depth(model, data, pair, np.array(c["frame"][:3])) for c in contacts]
    return None if None in depths else min(depths)


def record(program, model, file, *more):
    with open(file, "w") as out:
        subprocess.run([*program, model, "--steps", "0", "--tight", *more], stdout=out, stderr=subprocess.DEVNULL, check=True)
    return json.loads(pathlib.Path(file).read_text())


def by_pair(state):
    pairs = {}
    for c in state["contact"]:
        pairs.setdefault((c["geom1"], c["geom2"]), []).append(c)
    return pairs


def compare(labspec, oracle, path, folder):
    """Prints the pairs that differ; returns how many there are of each verdict, and the most that ours is deeper."""
    theirs = record([sys.executable, f"{oracle}/mj_record.py"], path, f"{folder}/m", "--states", "2")
    ours = record([labspec, "record"], path, f"{folder}/o", "--states", f"{folder}/m")
    model = mujoco.MjModel.from_xml_path(path)
    counts, most = collections.Counter(), 0.0
    print(path)
    for k, (m, o) in enumerate(zip(theirs["forward"], ours["forward"])):
        data = mujoco.MjData(model)
        data.qpos[:] = m["qpos"]
        if model.nmocap:
            data.mocap_pos[:], data.mocap_quat[:] = np.reshape(m["mocap_pos"], (-1, 3)), np.reshape(m["mocap_quat"], (-1, 4))
        mujoco.mj_kinematics(model, data)
        m, o = by_pair(m), by_pair(o)
        for pair in sorted({*m, *o}):
            there, here = m.get(pair, []), o.get(pair, [])
            if there and here:
                turned = np.abs(np.subtract(there[0]["frame"][:3], here[0]["frame"][:3])).max()
                moved = max((np.abs(np.subtract(a["pos"], b["pos"])).max() for a, b in zip(there, here)), default=0)
                if len(there) == len(here) and turned < SAME and moved < SAME:
                    continue
                along = [least(model, data, pair, contacts) for contacts in (there, here)]
                verdict = ("not known here" if None in along else "equal" if abs(along[0] - along[1]) < 1e-9
                           else "ours is less deep" if along[1] < along[0] else "OURS IS DEEPER")
                if verdict == "OURS IS DEEPER":
                    most = max(most, along[1] - along[0])
                print(f"  state {k} pair {pair}: {len(there)} contacts there, {len(here)} here; the first normals {turned:.0e} apart;"
                      f" depth along theirs {along[0]}, along ours {along[1]}: {verdict}")
            else:
                side, one = ("there", there) if there else ("here", here)
                along, verdict = least(model, data, pair, one), "only on one side"
                print(f"  state {k} pair {pair}: only {side}, {len(one)}, dist {[c['dist'] for c in one]}, depth along its normal {along}")
            counts[verdict] += 1
    return counts, most


VERDICTS = ["ours is less deep", "equal", "OURS IS DEEPER", "only on one side", "not known here"]

if __name__ == "__main__":
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for path in sys.argv[3:]:
            rows.append((path, *compare(sys.argv[1], sys.argv[2], path, folder)))
    print("\n| model | pairs that differ | " + " | ".join(v.lower() for v in VERDICTS) + " | by at most, m |")
    print("|---|" + "---:|" * (len(VERDICTS) + 2))
    for path, counts, most in rows:
        name = "/".join(pathlib.Path(path).parts[-2:]).removesuffix(".xml")
        print(f"| `{name}` | {sum(counts.values())} | " + " | ".join(str(counts[v]) for v in VERDICTS) + f" | {most:.0e} |")
