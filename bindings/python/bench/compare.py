#!/usr/bin/env python3
"""Times of the package beside those of `mujoco`, for the same models from the same start, in alternation.

    PYTHON bindings/python/bench/compare.py --models FOLDER --out docs/measured/python.md

PYTHON has `labspec` (a release wheel) and `mujoco`. FOLDER has pendulum.xml, cartpole.xml, chain100.xml and boxes27.xml.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

import labspec

REPEATS = 15
BALL = """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 1"/><body name="ball" pos="0 0 1"><freejoint/>
<geom name="ball" size="0.1"/></body></worldbody></mujoco>"""
SCENES = {"ball drop": (None, 20_000), "pendulum": ("pendulum", 20_000), "cart and pole": ("cartpole", 20_000)}
SCENES |= {"chain of 100 hinges": ("chain100", 300), "27 boxes piled": ("boxes27", 100)}


def seconds(work: Callable[[], object]) -> float:
    """The time of a call."""
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def medians(*works: Callable[[], object]) -> list[float]:
    """The median times of calls, made in alternation, s."""
    times = [[seconds(work) for work in works] for _ in range(REPEATS)]
    return [statistics.median(column) for column in zip(*times, strict=True)]


def ns(x: float) -> str:
    """Nanoseconds."""
    return f"{1e9 * x:,.0f}"


def stepping(name: str, xml: str, steps: int) -> list[str]:
    """A row: many steps in a call, a call for each step with a reading of `qpos`."""
    ours, theirs = labspec.Data(labspec.Model.from_xml(xml)), mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(theirs)

    def rewind() -> None:
        ours.reset()
        mujoco.mj_resetData(theirs, data)

    def single_ours() -> None:
        for _ in range(steps // 10):
            ours.step()
            ours.qpos[0]

    def single_theirs() -> None:
        for _ in range(steps // 10):
            mujoco.mj_step(theirs, data)
            data.qpos[0]

    many = []
    for _ in range(REPEATS):
        rewind()
        many.append([seconds(lambda: ours.step(steps)) / steps, seconds(lambda: mujoco.mj_step(theirs, data, steps)) / steps])
    bulk = [statistics.median(column) for column in zip(*many, strict=True)]
    if not np.allclose(ours.qpos, data.qpos, atol=1e-3):
        name += " ¹"
    rewind()
    single = [x / (steps // 10) for x in medians(single_ours, single_theirs)]
    return [name, *map(ns, bulk), f"{bulk[1] / bulk[0]:.1f}", *map(ns, single), f"{single[1] / single[0]:.1f}"]


def lab_steps(name: str, xml: str, steps: int) -> list[str]:
    """A row: a lab with a controller and a readout, whose programs run in each step, beside a loop of `mujoco` that does the same."""
    steps //= 10
    lab = labspec.Lab({"xml": xml, "controller": "ctx.x = data.qpos[0]", "readouts": [{"label": "q", "expr": "data.qpos[0]"}]})
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)

    def ours() -> None:
        lab.reset()
        lab.record(steps=steps)

    def theirs() -> None:
        mujoco.mj_resetData(model, data)
        mujoco.mj_forward(model, data)
        values = np.empty(steps + 1)
        for i in range(steps):
            values[i] = data.qpos[0]
            mujoco.mj_step(model, data)

    times = [x / steps for x in medians(ours, theirs)]
    return [name, *map(ns, times), f"{times[1] / times[0]:.1f}"]


def calls(xml: str) -> list[list[str]]:
    """Rows: what is not a step."""
    model, theirs = labspec.Model.from_xml(xml), mujoco.MjModel.from_xml_string(xml)
    ours, data = labspec.Data(model), mujoco.MjData(theirs)
    body = model.nbody - 1

    def repeated(work: Callable[[], object], count: int) -> Callable[[], object]:
        return lambda: [work() for _ in range(count)]

    pairs: list[tuple[str, Callable[[], object], Callable[[], object], int]] = [
        ("`data.qpos`", lambda: ours.qpos, lambda: data.qpos, 2000),
        ("`data.body(i).xpos`", lambda: ours.body(body).xpos, lambda: data.body(body).xpos, 500),
        ("`data.qpos[0] = x`", lambda: ours.qpos.__setitem__(0, 0.1), lambda: data.qpos.__setitem__(0, 0.1), 2000),
        ("model from XML", lambda: labspec.Model.from_xml(xml), lambda: mujoco.MjModel.from_xml_string(xml), 20),
        ("new data", lambda: labspec.Data(model), lambda: mujoco.MjData(theirs), 50),
    ]
    rows = []
    for name, one, other, count in pairs:
        times = [x / count for x in medians(repeated(one, count), repeated(other, count))]
        rows.append([name, *map(ns, times), f"{times[1] / times[0]:.1f}"])
    return rows


def import_time(module: str) -> float:
    """The time in which a new interpreter imports a module, without that of NumPy, s."""
    code = f"import numpy, time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    run = lambda: float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)  # noqa: E731
    return statistics.median(run() for _ in range(REPEATS))


def size(package: str) -> int:
    """The bytes of the files of a package that is installed."""
    folder = Path(__import__(package).__file__).parent
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file() and "__pycache__" not in file.parts)


def table(heads: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    lines = [heads, ["---"] + ["---:"] * (len(heads) - 1), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def report(models: Path) -> str:
    """The page."""
    texts = {name: (BALL if file is None else (models / f"{file}.xml").read_text(encoding="utf-8"), steps) for name, (file, steps) in SCENES.items()}
    heads = ["scene", "steps in one call: labspec, ns", "mujoco, ns", "times", "a call for each step: labspec, ns", "mujoco, ns", "times"]
    steps = table(heads, [stepping(name, *texts[name]) for name in texts])
    note = "¹ The states at the end differ by more than 1e-3: the scene is chaotic, or a pile.\n\n" if "¹" in steps else ""
    labs = table(["scene", "labspec, ns", "mujoco, ns", "times"], [lab_steps(name, *texts[name]) for name in texts])
    other = table(["call", "labspec, ns", "mujoco, ns", "times"], calls(texts["27 boxes piled"][0]))
    imports = [f"{1e3 * import_time(module):.0f} ms" for module in ("labspec", "mujoco")]
    sizes = [f"{size(module) / 1e6:.1f} MB" for module in ("labspec", "mujoco")]
    return f"""# Speed in Python

The package `labspec` beside `mujoco` {mujoco.__version__}: the same models from the same start, in alternation, the medians of {REPEATS} repeats, with Python {platform.python_version()} on {os.cpu_count()} cores of {processor()}. Measured by

    PYTHON bindings/python/bench/compare.py --models ../shared/bench --out docs/measured/python.md

with a release wheel, on a machine that others used, too. *Times* is how often labspec is as fast. All fields are computed in every step, as `mujoco` does.

{steps}

{note}A lab computes only what its programs read. This one has a controller and a readout, and is recorded in one call (`lab.record`); a loop of `mujoco` reads the same number in each step:

{labs}

Other calls, for the 27 boxes:

{other}

| | labspec | mujoco |
|---|---:|---:|
| `import`, after NumPy | {imports[0]} | {imports[1]} |
| files of the package that is installed | {sizes[0]} | {sizes[1]} |
"""


def processor() -> str:
    """The name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine()
    return next((line.partition(": ")[2] for line in lines if line.startswith("model name")), platform.machine())


def main() -> None:
    """Prints the page, or writes it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    text = report(given.models)
    if given.out is None:
        print(text)
    else:
        given.out.write_text(text, encoding="utf-8")
        print(json.dumps({"written": str(given.out)}))


if __name__ == "__main__":
    main()
