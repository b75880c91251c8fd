"""Records how MuJoCo 3.14.0 wraps tendons: `python record.py` with mujoco==3.14.0.

Writes wrap.txt, a line for each random case: shape (4 sphere, 5 cylinder), radius, position (3) and rotation matrix
(9) of the geom, both ends (3 and 3), 1 or 0 for a side site, its position (3); then the length of the whole path
and either `free` or both points on the surface (3 and 3).
"""

import pathlib

import mujoco
import numpy as np

SCENE = """<mujoco><worldbody>
  <geom name="g" type="{shape}" size="{radius!r} 1" pos="{pos}" euler="{turn}"/>
  <site name="a" pos="{a}"/><site name="b" pos="{b}"/><site name="s" pos="{side}"/>
</worldbody><tendon><spatial><site site="a"/><geom geom="g"{with_side}/><site site="b"/></spatial></tendon></mujoco>"""


def text(numbers):
    return " ".join(repr(float(x)) for x in np.ravel(numbers))


def case(rng):
    shape = rng.choice(["sphere", "cylinder"])
    radius = float(rng.uniform(0.1, 0.5))
    pos = np.round(rng.normal(size=3) * 0.3, 3)
    a, b = np.round(pos + rng.normal(size=(2, 3)) * rng.choice([0.5, 1.0, 2.0]), 3)
    kind = rng.integers(6)
    if kind == 0:
        b = pos - (a - pos) * 0.5  # in line with the centre
    if kind == 1:
        b = pos + (a - pos) * 1.5
    inside = rng.random() < 0.4
    side = np.round(pos + rng.normal(size=3) * (0.1 * radius if inside else 1.0), 3)
    with_side = rng.random() < 0.7
    scene = SCENE.format(
        shape=shape, radius=radius, pos=text(pos), turn=text(rng.uniform(-180, 180, 3)), a=text(a), b=text(b),
        side=text(side), with_side=' sidesite="s"' if with_side else "",
    )
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    wrapped = data.ten_wrapnum[0] == 4
    points = data.wrap_xpos.reshape(-1, 3)[1:3]
    given = [radius, data.geom_xpos, data.geom_xmat, data.site_xpos[:2], with_side, data.site_xpos[2]]
    head = f"{model.wrap_type[1]} " + " ".join(text(x) for x in given)
    return f"{head} {text(data.ten_length)} {text(points) if wrapped else 'free'}"


rng = np.random.default_rng(1)
lines = [case(rng) for _ in range(400)]
(pathlib.Path(__file__).parent / "wrap.txt").write_text("\n".join(lines) + "\n")
