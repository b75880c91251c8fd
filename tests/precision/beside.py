#!/usr/bin/env python3
"""Runs of a lab by MuJoCo, to stand beside ours: `labspec precision LAB --beside FILE`.

    beside.py LAB.json REPORT.json > FILE

LAB.json holds its model in `xml`; its `setup` and traces are read as Python, which for assignments, indexes and arithmetic means
the same. REPORT.json is what `labspec precision LAB.json --format json` printed: the times to sample at and the timesteps come
from it; a run with longer steps is sampled after each. Needs mujoco==3.14.0 and numpy. Times are the medians of five repeats of at most 4 ms, one setting after the other.
"""
import json, math, statistics, sys, time

import mujoco
import numpy as np

lab, report = (json.load(open(path)) for path in sys.argv[1:3])
INTEGRATORS = {"Euler": 0, "RK4": 1, "implicit": 2, "implicitfast": 3, "discrete": 4}
REPEATS, LONG_ENOUGH, CHUNK = 5, 4e-3, 32


class Math:
    sin, cos, sqrt, exp, asin, PI = math.sin, math.cos, math.sqrt, math.exp, math.asin, math.pi


traces = [trace for plot in lab["plots"] for trace in plot["traces"]]
codes = [compile(trace["expr"], trace["label"], "eval") for trace in traces]
count = report["samples"]
interval = report["length"] / count


def start(integrator, timestep):
    model = mujoco.MjModel.from_xml_string(lab["xml"])
    model.opt.integrator, model.opt.timestep = INTEGRATORS[integrator], timestep
    data = mujoco.MjData(model)
    exec(lab.get("setup", ""), {"data": data, "model": model, "Math": Math})
    mujoco.mj_forward(model, data)
    return model, data


def values(model, data):
    return [float(eval(code, {"data": data, "model": model, "Math": Math})) for code in codes]


def run(integrator, timestep):
    model, data = start(integrator, timestep)
    every = max(1, round(interval / timestep))
    columns = [values(model, data)]
    for _ in range(round(report["length"] / (every * timestep))):
        mujoco.mj_step(model, data, every)
        columns.append(values(model, data))
    return np.array(columns).T.tolist()


def repeat(integrator, timestep):
    model, data = start(integrator, timestep)
    steps, made, began = round(report["length"] / timestep), 0, time.perf_counter()
    while made < steps and (made == 0 or time.perf_counter() - began < LONG_ENOUGH):
        chunk = min(CHUNK, steps - made)
        mujoco.mj_step(model, data, chunk)
        made += chunk
    return 1e6 * (time.perf_counter() - began) / (made * timestep)


settings = [(row["integrator"], row["timestep"]) for row in report["rows"] if row["integrator"] in INTEGRATORS and not row["solver"]]
costs = [[] for _ in settings]
for _ in range(REPEATS):
    for cost, setting in zip(costs, settings):
        cost.append(repeat(*setting))
rows = [
    dict(integrator=i, timestep=h, microsecondsPerSecond=statistics.median(cost), values=run(i, h))
    for (i, h), cost in zip(settings, costs)
]
json.dump(
    dict(engine="MuJoCo " + mujoco.__version__, traces=[t["label"] for t in traces], times=[k * interval for k in range(count + 1)], rows=rows),
    sys.stdout,
)
