#!/usr/bin/env python3
"""Records what MuJoCo 3.14.0 computes for the models of ../shared (conformance, corpus, bench), which are not copied here:
the reference of tests/conformance.rs.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python conformance.py [--states 2] [--out conformance] [MODEL ...]

A file each, as zoo.py writes them, with numbers only: two states of the eight that the test compares when it can run the
library itself (LABSPEC_ORACLE names its Python).
"""
import argparse
import pathlib

import recording

HERE = pathlib.Path(__file__).parent
SHARED = HERE.parent.parent.parent / "shared"
FOLDERS = {"conformance": "conformance/models", "corpus": "corpus/models", "bench": "bench"}


def main():
    p = argparse.ArgumentParser()
    p.add_argument("models", nargs="*")
    p.add_argument("--states", type=int, default=2)
    p.add_argument("--out", type=pathlib.Path, default=HERE / "conformance")
    a = p.parse_args()
    for kind, folder in FOLDERS.items():
        for path in sorted((SHARED / folder).glob("*.xml")):
            name = kind + "/" + path.stem
            if not a.models or name in a.models:
                size = recording.write(a.out / (name + ".json"), recording.record(path, a.states, 0.1, short=True))
                print(f"{size:8} {name}")


if __name__ == "__main__":
    main()
