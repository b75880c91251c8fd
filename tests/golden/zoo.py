#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for the zoo, specs/models/zoo: the reference of tests/zoo.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python zoo.py [MODEL ...]

zoo/MODEL.json holds the compiled constants, eight states with every field after a forward pass, and a trajectory
for each integrator, all with constraints switched off.
"""
import pathlib
import sys

import recording

HERE = pathlib.Path(__file__).parent
MODELS = HERE.parent.parent / "specs/models/zoo"


def main(names):
    for name in names or sorted(p.stem for p in MODELS.glob("*.xml")):
        size = recording.write(HERE / "zoo" / (name + ".json"), recording.record(MODELS / (name + ".xml"), 8, 0.3))
        print(f"{size:8} {name}")


if __name__ == "__main__":
    main(sys.argv[1:])
