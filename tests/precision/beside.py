#!/usr/bin/env python3
"""Runs of a lab by MuJoCo, to stand beside ours: `labspec precision LAB --beside FILE`.

    beside.py LAB.json REPORT.json > FILE

LAB.json holds its model in `xml`; its `setup` and traces are read as Python, which for assignments, indexes and arithmetic means
the same. REPORT.json is what `labspec precision LAB.json --format json` printed: the times to sample at and the timesteps come
from it; a run with longer steps is sampled after each. Needs mujoco==3.14.0 and numpy. Times are the medians of five
repeats of the whole run, one setting after the other.
"""
import json, math, statistics, sys, time

import mujoco
import numpy as np

lab, report = (json.load(open(path)) for path in sys.argv[1:3])
INTEGRATORS = {"Euler": 0, "RK4": 1, "implicit": 2, "implicitfast": 3, "discrete": 4}
REPEATS, LONG_ENOUGH = 5, 2e-3


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
    # Long steps need not divide the run: to the last whole one.
    for _ in range(int(report["length"] / (every * timestep) + 1e-6)):
        mujoco.mj_step(model, data, every)
        columns.append(values(model, data))
    return np.array(columns).T.tolist()


def repeat(integrator, timestep):
    model, data = start(integrator, timestep)
    steps, began = int(report["length"] / timestep + 1e-6), time.perf_counter()
    mujoco.mj_step(model, data, steps)
    return time.perf_counter() - began, steps * timestep


settings = [(row["integrator"], row["timestep"]) for row in report["rows"] if row["integrator"] in INTEGRATORS and not row["solver"]]
costs = [[] for _ in settings]
for _ in range(REPEATS):
    for cost, setting in zip(costs, settings):
        # The whole run, again and again until it took long enough.
        took = simulated = 0.0
        while took < LONG_ENOUGH:
            more, length = repeat(*setting)
            took, simulated = took + more, simulated + length
        cost.append(1e6 * took / simulated)
rows = [
    dict(integrator=i, timestep=h, microsecondsPerSecond=statistics.median(cost), values=run(i, h))
    for (i, h), cost in zip(settings, costs)
]
json.dump(
    dict(engine="MuJoCo " + mujoco.__version__, traces=[t["label"] for t in traces], times=[k * interval for k in range(count + 1)], rows=rows),
    sys.stdout,
)
