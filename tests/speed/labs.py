#!/usr/bin/env python3
"""What a step of each lab of the corpus costs, planned and with every field, beside MuJoCo: docs/measured/speed.md, "Labs".

    PYTHON tests/speed/labs.py [LAB...] [--out docs/measured/speed.md] [--rounds 5]

PYTHON has the package `mujoco` 3.14.0. Ours is `labspec plan`: the lab's own run with its setup and controller, stepped without a page;
the controller's time counts. MuJoCo steps the same model through the same run: every hundred steps it gets the state, controls and
written parameters of ours (`labspec run`), and `mj_step` is timed for the hundred steps, without any program of the lab. The two
take turns. Other programs can only make a measurement longer, so the shortest one counts: of ours in all rounds (each is the median of
seven), of MuJoCo for each hundred steps.
"""
import argparse
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import mujoco
import numpy

OURS = "target/release/labspec"
LABS = pathlib.Path("../shared/corpus/labs")
MODELS = pathlib.Path("../shared/corpus/models")
CHUNK = 100


def ours(command, lab, *options):
    out = subprocess.run([OURS, command, str(lab), "--models", str(MODELS), *options], capture_output=True, text=True)
    if out.returncode > 1:
        sys.exit(out.stderr)
    return json.loads(out.stdout)


def model_of(lab):
    """MuJoCo's model of a lab."""
    spec = json.loads(lab.read_text())
    if "xml" in spec:
        return mujoco.MjModel.from_xml_string(spec["xml"])
    return mujoco.MjModel.from_xml_path(str(MODELS / (spec["model"] + ".xml")))


class Run:
    """The states of a lab's own run, for MuJoCo to start from every so many steps."""

    def __init__(self, lab, plan, folder):
        self.model = model_of(lab)
        self.data = mujoco.MjData(self.model)
        self.chunks = {}
        self.steps = plan["step"]["steps"]
        # What is copied: the state, the controls, and the parameters that the lab's programs may write.
        places = [(self.data, "data", name) for name in ("qpos", "qvel", "act", "ctrl", "qfrc_applied", "xfrc_applied")]
        for name in plan["writes"]:
            if hasattr(self.model.opt, name):
                places.append((self.model.opt, "model.opt", name))
            elif hasattr(self.model, name) and not hasattr(self.data, name):
                places.append((self.model, "model", name))
        spec = json.loads(lab.read_text())
        spec["readouts"], spec["plots"], self.places = [], [], []
        for owner, path, name in places:
            now = getattr(owner, name)
            size = numpy.size(now)
            self.places.append((owner, name, size))
            for i in range(size):
                expr = f"{path}.{name}" if numpy.ndim(now) == 0 else f"{path}.{name}[{i}]"
                spec["readouts"].append({"label": f"{path} {name} {i}", "expr": expr})
        copy = pathlib.Path(folder) / "lab.json"
        copy.write_text(json.dumps(spec))
        table = ours("run", copy, "--steps", str(self.steps), "--every", str(CHUNK), "--format", "json")
        self.rows = [row[1:] for row in table["rows"]]

    def put(self, row):
        """MuJoCo's model and data as ours were."""
        at = 0
        for owner, name, size in self.places:
            values = row[at:at + size]
            at += size
            now = getattr(owner, name)
            if isinstance(now, numpy.ndarray):
                now.ravel()[:] = values
            else:
                setattr(owner, name, type(now)(values[0]))

    def times(self, passes=3):
        """What the chunks of the run take, each as often as it was made."""
        chunks = [(row, min(CHUNK, self.steps - CHUNK * i)) for i, row in enumerate(self.rows)]
        for i, (row, n) in enumerate(chunks * passes):
            if n <= 0:
                continue
            self.put(row)
            start = time.perf_counter_ns()
            mujoco.mj_step(self.model, self.data, nstep=n)
            self.chunks.setdefault(i % len(chunks), []).append(time.perf_counter_ns() - start)

    def step_ns(self):
        """A step: the sum of the shortest times of the chunks."""
        return sum(map(min, self.chunks.values())) / self.steps


LENGTHS = (20_000, 100_000)


def whole_run_seconds(lab, steps, settings=()):
    """The processor time of `labspec run --full`, with all that it watches. A run that breaks is no measure of its steps."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    arguments = [part for setting in settings for part in ("--set", setting)]
    report = ours("run", lab, "--full", "--steps", str(steps), "--every", "10000", "--format", "json", *arguments)
    if report["breakdowns"]:
        sys.exit(f"{lab}: the run breaks: {report['breakdowns']}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def measure(lab, rounds, lengths=LENGTHS, settings=()):
    """A line of the table. The column `run --full` is the slope of its processor time over the number of steps, from runs of two lengths
    with some settings (of `--set`)."""
    with tempfile.TemporaryDirectory() as folder:
        first = ours("plan", lab, "--format", "json")
        if first["step"] is None:
            return None
        run = Run(lab, first, folder)
        run.times(1)
        run.chunks.clear()
        planned, full, times = [], [], []
        for _ in range(rounds):
            step = ours("plan", lab, "--format", "json")["step"]
            planned.append(step["ns"])
            full.append(step["fullNs"])
            times.append([whole_run_seconds(lab, steps, settings) for steps in lengths])
            run.times()
    planned, full = min(planned), min(full)
    short, long = map(min, zip(*times))
    run_ns = 1e9 * (long - short) / (lengths[1] - lengths[0])
    library = run.step_ns()
    ratio, full_ratio, run_ratio = library / planned, library / full, library / run_ns
    rows, touch = first["solver"]["rows"], first["pairs"]["canTouch"] > 0
    aim = 3 if touch or rows["most"] else 6
    kept = sum(stage["keep"] for stage in first["stages"])
    return [lab.stem.replace("_simlab", ""), f"{kept}", f"{rows['mean']:.1f}", f"{planned:.0f}", f"{full:.0f}", f"{library:.0f}",
            f"1/{ratio:.1f}", f"1/{full_ratio:.1f}", f"1/{run_ratio:.1f}", f"1/{aim}",
            "" if ratio >= aim and run_ratio >= 2 else "missed"]


def table(first, rows):
    """The lines of a table whose first column has this head; rows are printed as they come."""
    heads = [first, "stages", "rows", "planned, ns", "every field, ns", "MuJoCo, ns", "planned to MuJoCo", "every field", "`run --full`",
             "aim", ""]
    lines = ["| " + " | ".join(heads) + " |", "|---" + "|---:" * (len(heads) - 2) + "|---|"]
    for cells in rows:
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return lines


def replace_table(page, section, lines):
    """Puts a table in the place of the one that a section of a page has."""
    text, new = page.read_text(), "\n".join(lines)
    first = lines[0].split("|")[1].strip()
    pattern = rf"(\n## {re.escape(section)}\n.*?\n)\| {re.escape(first)} \|.*?\n\n"
    text, count = re.subn(pattern, lambda m: m.group(1) + new + "\n\n", text, count=1, flags=re.S)
    if not count:
        sys.exit(f"{page} has no section `{section}` with a table")
    page.write_text(text)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("labs", nargs="*", type=pathlib.Path)
    p.add_argument("--out", type=pathlib.Path)
    p.add_argument("--rounds", type=int, default=5)
    a = p.parse_intermixed_args()
    labs = a.labs or sorted(LABS.glob("*.json"))
    lines = table("lab", (measure(lab, a.rounds) or [lab.stem, "does not run"] for lab in labs))
    if a.out:
        replace_table(a.out, "Labs", lines)


if __name__ == "__main__":
    main()
