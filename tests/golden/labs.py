#!/usr/bin/env python3
"""Records the traces of the labs of ../shared as a page would run them: the reference of tests/labs.rs.

    npm install @mujoco/mujoco@3.14.0
    python3 labs.py NODE_MODULES [--shared ../shared] [--until 2] [--rows 25]

Every lab as it opens, with each of its sliders and choices at either end, and with each of its buttons pressed at the
start; where a lab grips something, also with the solver run to rounding ("tight"). JavaScript evaluates the expressions, on the official build of MuJoCo 3.14.0 (`../shared/oracle/lab_oracle.mjs`).
Kept are a few rows of each run and the range of every column over all of its steps.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

HERE = pathlib.Path(__file__).parent
TIGHT = "model.opt.tolerance = 0; model.opt.ls_tolerance = 1e-10; model.opt.iterations = 200; model.opt.ls_iterations = 100; "


def variants(lab):
    """What is done to a lab: labels set to values, labels pressed."""
    yield [], []
    for control in lab.get("controls", []):
        label, kind = control["label"], control.get("type", "slider")
        if kind == "button":
            yield [], [label]
            continue
        values = [v for _, v in control["options"]] if kind == "select" else [control.get("min"), control.get("max")]
        for value in (v for v in values if isinstance(v, (int, float)) and not isinstance(v, bool)):
            if value != control.get("value"):
                yield [[label, value]], []


def span(column):
    """The range of a column, and no less than what rounding leaves of its largest number."""
    numbers = [v for v in column if isinstance(v, (int, float)) and not isinstance(v, bool)]
    if not numbers:
        return 1.0
    return max(1e-12, max(numbers) - min(numbers), 1e-9 * max(abs(v) for v in numbers))


def run(a, lab, set_, press, tight):
    if tight:
        lab = {**lab, "setup": TIGHT + lab.get("setup", "")}
    path = a.scratch / "lab.json"
    path.write_text(json.dumps(lab))
    command = ["node", a.shared / "oracle/lab_oracle.mjs", path, "--models", a.shared / "corpus/models"]
    command += ["--mujoco", a.node_modules, "--until", str(a.until)]
    for label, value in set_:
        command += ["--set", f"{label}={value!r}"]
    for label in press:
        command += ["--press", f"{label}@0"]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{lab.get('title')} {set_} {press}: {done.stderr}")
    return json.loads(done.stdout)


def record(a, path):
    lab = json.loads(path.read_text())
    for set_, press in variants(lab):
        for tight in (False, True):
            if tight and not grips(lab):
                continue
            found = run(a, lab, set_, press, tight)
            rows = found["rows"]
            every = max(1, math.ceil((len(rows) - 1) / a.rows))
            yield {
                "lab": path.stem, "set": set_, "press": press, "tight": tight, "steps": len(rows) - 1, "every": every,
                "columns": found["columns"], "warnings": found["warnings"],
                "span": [span(column) for column in zip(*rows)],
                "rows": [row for i, row in enumerate(rows) if i % every == 0 or i == len(rows) - 1],
            }


def grips(lab):
    """Whether the solver has work that it may leave early: two fingers, a cube and the floor at once."""
    return "gripper" in lab.get("model", "")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("node_modules", type=pathlib.Path)
    arguments.add_argument("--shared", type=pathlib.Path, default=HERE.parent.parent.parent / "shared")
    arguments.add_argument("--until", type=float, default=2.0)
    arguments.add_argument("--rows", type=int, default=25)
    a = arguments.parse_args()
    a.scratch = pathlib.Path(tempfile.mkdtemp())
    paths = sorted((a.shared / "corpus/labs").glob("*.json"))
    runs = [json.dumps(r, ensure_ascii=False) for path in paths for r in record(a, path)]
    (HERE / "labs.json").write_text("[\n" + ",\n".join(runs) + "\n]\n")
    print(f"{len(runs)} runs of {len(paths)} labs")


main()
