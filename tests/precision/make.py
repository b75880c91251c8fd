#!/usr/bin/env python3
"""Writes docs/precision.md and its pictures: the standard set, ours beside MuJoCo.

    cargo build --release -p labspec
    tests/precision/make.py target/release/labspec mj/bin/python      # a Python with mujoco==3.14.0 and numpy

A minute. Run times are this machine's, of both in the same minutes; errors are the same everywhere but for rounding.
"""
import glob, json, os, subprocess, sys, tempfile

LABSPEC, PYTHON = (os.path.abspath(p) if os.sep in p else p for p in sys.argv[1:3])
HERE = os.path.dirname(os.path.abspath(__file__))
DOCS = os.path.join(HERE, "..", "..", "docs")
# Curves of the pictures; the tables have all.
DRAWN = ["Euler", "RK4", "implicitfast", "discrete", "rkmk4", "rkmk8", "adaptive"]
ORDERS = {"Euler": 1, "implicit": 1, "implicitfast": 1, "discrete": 1, "RK4": 4, "rkmk4": 4, "rkmk8": 8, "gauss": 6}
OWN = ("rkmk4", "rkmk8", "gauss", "adaptive")


def labspec(lab, *arguments):
    done = subprocess.run([LABSPEC, "precision", lab, *arguments, "--format", "json"], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def compare(lab, folder):
    """All runs of ours, with MuJoCo's beside."""
    name = os.path.basename(lab)[:-5]
    first, recording = (os.path.join(folder, f"{name}.{end}.json") for end in ("report", "mujoco"))
    with open(first, "w") as out:
        json.dump(labspec(lab, "--integrator", "all"), out)
    with open(recording, "w") as out:
        subprocess.run([PYTHON, os.path.join(HERE, "beside.py"), lab, first], stdout=out, check=True)
    picture = f"precision-{name[3:].replace('_', '-')}.svg"
    drawn = [word for name in DRAWN for word in ("--integrator", name)]
    labspec(lab, *drawn, "--beside", recording, "--svg", os.path.join(DOCS, "pictures", picture))
    return labspec(lab, "--integrator", "all", "--beside", recording), picture


def sci(x):
    return "–" if x is None else f"{x:.1e}".replace("e-0", "e-").replace("e+0", "e")


def good(row):
    return row["fate"] == "good" and row["errors"] and row["errors"][0] is not None


def floor(report):
    """What is below this nobody knows: the reference's own error, or rounding."""
    return max(report["uncertainty"][0] or 0, 2e-12 * max(1, report["unseen"][0] * 300))


def domination(report):
    """Of MuJoCo's runs, those that one of ours is as close as and no more expensive; and the others."""
    ours = [(max(r["errors"][0], floor(report)), r["microsecondsPerSecond"]) for r in report["rows"] if good(r)]
    theirs = [r for r in report["beside"]["rows"] if r["errors"][0] is not None]
    below = lambda r: any(e <= 1.001 * max(r["errors"][0], floor(report)) and c <= r["microsecondsPerSecond"] for e, c in ours)
    return [r for r in theirs if below(r)], [r for r in theirs if not below(r)]


def agreement(report):
    """The errors of both programs at one setting, where both are above what nobody knows: how far apart, in parts of the larger."""
    theirs = {(r["integrator"], r["timestep"]): r["errors"][0] for r in report["beside"]["rows"]}
    for row in filter(good, report["rows"]):
        ours, other = row["errors"][0], theirs.get((row["integrator"], row["timestep"]))
        if other is not None and max(ours, other) > 10 * floor(report):
            yield abs(ours - other) / max(ours, other)


def closest(rows, cost, floor):
    rows = [(max(r["errors"][0], floor), r) for r in rows if r["microsecondsPerSecond"] <= cost and r["errors"][0] is not None]
    return min(rows, key=lambda x: (x[0], x[1]["microsecondsPerSecond"]), default=(None, None))


def setting(row):
    return f"{row['integrator']}, {1e3 * row['timestep']:g} ms"


def order(report, integrator):
    """The order that a method shows: that of the shortest timesteps that are above rounding."""
    seen = [r["orders"][0] for r in report["rows"] if r["integrator"] == integrator and good(r) and r["orders"][0] is not None]
    return seen[-1] if seen else None


def main():
    with tempfile.TemporaryDirectory() as folder:
        labs = sorted(glob.glob(HERE + "/[0-9]*.json"))
        reports = [(json.load(open(lab)), *compare(lab, folder)) for lab in labs]
    out = [INTRODUCTION]
    out.append("## The same time, how close\n")
    out.append(
        "What MuJoCo's Euler method at 2 ms costs buys this, with MuJoCo's best method for that time, with ours among the same five, "
        "and with all of ours. Largest errors of the first trace, in its unit.\n"
    )
    out.append("| scene | MuJoCo, Euler, 2 ms | MuJoCo's best | ours, the same five | ours, all |\n|---|---:|---:|---:|---:|")
    below_all, above_all = 0, []
    for lab, report, _ in reports:
        theirs, limit = report["beside"]["rows"], floor(report)
        mark = next(r for r in theirs if r["integrator"] == "Euler" and r["timestep"] == 0.002)
        cost = mark["microsecondsPerSecond"]
        rows = [r for r in report["rows"] if good(r)]
        cells = []
        for some in (theirs, [r for r in rows if r["integrator"] not in OWN], rows):
            error, row = closest(some, cost, limit)
            cells.append("–" if row is None else f"{'≤' if error <= limit else ''}{sci(error)} ({setting(row)})")
        out.append(f"| {lab['title']} | {sci(mark['errors'][0])} | " + " | ".join(cells) + " |")
        below, above = domination(report)
        below_all += len(below)
        above_all += [(lab["title"], r) for r in above]
    total = below_all + len(above_all)
    out.append(f"\nOf MuJoCo's {total} runs, {below_all} have one of ours that is as close or closer and takes no more time.")
    if above_all:
        listed = "; ".join(f"{title}: {setting(r)}" for title, r in above_all)
        out.append(f"The others: {listed}.")
    for what, some in (("without contacts", [r for _, r, _ in reports if not r["penetration"]]), ("with contacts", [r for _, r, _ in reports if r["penetration"]])):
        apart = sorted(x for report in some for x in agreement(report))
        if apart:
            close = sum(x < 1e-3 for x in apart)
            out.append(
                f"\nWhere both programs have a method, their errors in the scenes {what} are the same to one part in a thousand at {close} of {len(apart)} "
                f"settings (median difference {sci(apart[len(apart) // 2])}, largest {sci(apart[-1])})."
            )
    out.append("\n## Orders\n")
    out.append(
        "How many times the error halves when the timestep halves, for the shortest timesteps whose errors are above rounding, above the "
        "doubt of the reference, and small beside the range, and where the next pair of steps shows the same; nothing stands where there "
        "are none. Scenes in which forces jump (contacts, limits, dry friction), and chaotic ones, have no order.\n"
    )
    names = list(ORDERS)
    out.append("| scene | " + " | ".join(names) + " |\n|---|" + "---:|" * len(names))
    out.append("| *in theory* | " + " | ".join(f"*{ORDERS[n]}*" for n in names) + " |")
    for lab, report, _ in reports:
        if report["penetration"]:
            continue
        cells = [order(report, n) for n in names]
        if not any(cells):
            continue
        out.append(f"| {lab['title']} | " + " | ".join("" if c is None else f"{c:.2f}" for c in cells) + " |")
    out.append("\nRK4 is of second order on the top and on the tumbling box, which turn in space: it adds turns that do not add. " + NOTE)
    for lab, report, picture in reports:
        out.append(f"\n## {lab['title']}\n")
        truth = "the closed form" if report["truth"][0] == "closedForm" else f"{report['reference']}, which agree to {sci(report['uncertainty'][0])}"
        out.append(f"{report['length']:g} s; errors are against {truth}. `tests/precision/` has the lab.\n")
        out.append(f"![{lab['title']}: cost against error](pictures/{picture})\n")
        out += [f"* {a['text']}" for a in report["advice"]]
    out.append(WRONG)
    with open(os.path.join(DOCS, "precision.md"), "w") as page:
        page.write("\n".join(out) + "\n")


INTRODUCTION = """# Error against run time

What a timestep and an integrator cost in error, and what closer answers cost in time: eleven scenes that show one thing each, ours
beside MuJoCo 3.14.0. `labspec precision LAB` makes such a comparison of any lab; this page is written by

    cargo build --release -p labspec
    tests/precision/make.py target/release/labspec PYTHON      # a Python with mujoco==3.14.0 and numpy

Errors are largest errors over the run; times are microseconds for a simulated second, medians of repeats of the whole run in turn, of
both programs in the same minutes: they illustrate, and differ from day to day. What decides in the advice below is work as the engine
counts it, with what an integrator adds to a step (derivatives and their factors, measured here): the same on every machine. Bars in the
pictures are the middle half of the repeats; an arrow to the left says that an error is at most what it stands at. Filled marks and lines are ours, hollow and dotted ones MuJoCo's. Further left is closer, further down is cheaper.

Euler, implicit, implicitfast, RK4 and discrete are MuJoCo's methods, in both programs. Four are our own, off by
default, and known to programs that embed the engine (`Integrator`), not to a page that runs MuJoCo: `rkmk4` is Runge and Kutta's method
for bodies that turn (Munthe-Kaas), `rkmk8` the same of eighth order (Cooper and Verner), `gauss` a symmetric collocation of sixth order,
whose error in energy does not grow with time where the scene keeps it (Hairer, Lubich, Wanner), `adaptive` takes as many steps within a step as rounding asks for (Bulirsch and Stoer).
"""
WRONG = """
## What was wrong here

* Events of this page's reports (`labspec precision LAB --format json`) were interpolated between the steps, and both references
  shared the mistake: 11 of 20 times lay outside their `±`, one 1.3e-9 off where 4.7e-16 was claimed. They are found between the steps now,
  by shorter steps from the state before; on the 21 labs of `tests/precision/kinds.md`, whose truth is known by other means
  (`tests/golden/precision.py`), all 50 times are inside their `±`.
* The table of orders had 2.63 (Euler, discrete and implicitfast), 1.27 (implicit), 8.75 (rkmk8) and 5.57 (gauss) for the energy of the
  double pendulum, and 2.03 for Euler on the top: these were errors as large as what is measured, or a single pair of steps, and no orders.
* "The cheapest setting tried" went no farther than four times the lab's own step, and took the clock of a run's first 4 ms: for free fall
  and the pendulum it was Euler at 4 ms. Longer steps are tried now, and work decides.
* What a plot hides was measured on the lab's own run even where that breaks. It is that of the true curve.
* The doubt of a reference was the difference of its two families. It is twice that: both may be off to the same side.
"""
NOTE = "`rkmk4` takes the same four evaluations and keeps its order there.\n"

main()
