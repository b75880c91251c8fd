"""Records forces of a medium on ellipsoids: `python record.py` with mujoco==3.14.0.

Writes ellipsoid.txt, a line for each random case of one geom at the origin of a free body: density, viscosity,
geom type, size (3), geom_fluid (12), angular and linear velocity (3 and 3), torque and force (3 and 3).
"""

import pathlib

import mujoco
import numpy as np

SCENE = """<mujoco><option density="{density!r}" viscosity="{viscosity!r}" gravity="0 0 0"/><worldbody>
<body><freejoint/><geom type="{shape}" size="{size}" fluidshape="ellipsoid" fluidcoef="{coef}"/></body>
</worldbody></mujoco>"""


def text(numbers):
    return " ".join(repr(float(x)) for x in np.ravel(numbers))


def case(rng, i):
    shape = ["sphere", "capsule", "ellipsoid", "cylinder", "box"][i % 5]
    density, viscosity = float(rng.uniform(0, 1000)), float(rng.uniform(0, 2))
    if i % 7 == 0:
        density = 0.0
    if i % 7 == 1:
        viscosity = 0.0
    scene = SCENE.format(
        density=density, viscosity=viscosity, shape=shape,
        size=text(rng.uniform(0.01, 0.5, 3) * ([1, 1, 1e-3] if i % 3 == 0 else 1)), coef=text(rng.uniform(0, 2, 5)),
    )
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    data.qvel[:] = rng.normal(size=6) * (0 if i % 11 == 0 else 1)
    mujoco.mj_forward(model, data)
    motion = [data.qvel[3:], data.qvel[:3]]
    force = [data.qfrc_fluid[3:], data.qfrc_fluid[:3]]
    given = [model.geom_type, model.geom_size, model.geom_fluid, motion, force]
    return f"{density!r} {viscosity!r} " + " ".join(text(x) for x in given)


rng = np.random.default_rng(1)
lines = [case(rng, i) for i in range(100)]
(pathlib.Path(__file__).parent / "ellipsoid.txt").write_text("\n".join(lines) + "\n")
