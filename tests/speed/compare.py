#!/usr/bin/env python3
"""Cost of a step compared with MuJoCo: time, measured in the same run, and instructions, which are repeatable.

    cargo build --release -p labspec-cli
    tests/speed/compare.py BENCH_MUJOCO [--out docs/measured/speed.md] [NAME=MODEL.xml[,warm[,steps[,off]]] ...]

BENCH_MUJOCO is the program made from `bench_mujoco.c` of the oracle. Without models, those of SCENES are measured, which
are in ../shared. `off` names what is switched off on both sides: `contact` or `constraint`.

Times are of the processor, not of the clock on the wall, so that other programs do not count: a run of many steps less one
of few, ours and theirs in turn, and the median of the pairs. Instructions are counted by valgrind's callgrind, when it is
there, in the same steps. Ours are measured twice: with the plan of a lab that reads the state alone, and with every field
computed in every step, as MuJoCo does. Needs Python 3.9 or newer.
"""
import argparse
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

OURS = "target/release/labspec"
ADVANCE = "labspec_developer::bench::advance"
BENCH, MODELS = "../shared/bench/", "../shared/conformance/models/"
SCENES = [
    f"pendulum={BENCH}pendulum.xml,100,200000",
    f"double pendulum={BENCH}double_pendulum.xml,100,200000",
    f"cart and pole={BENCH}cartpole.xml,100,200000",
    f"chain of 100 hinges={BENCH}chain100.xml,100,3000",
    f"humanoid, constraints off={MODELS}benchmark__humanoid.xml,100,10000,constraint",
    f"humanoid, contacts off={MODELS}mjx__humanoid__humanoid.xml,100,10000,contact",
    "two balls at rest=../shared/corpus/models/ball_drop.xml,2000,50000",
    "cube on a table=../shared/corpus/models/cube_table.xml,2000,20000",
    "gripper=../shared/corpus/models/gripper.xml,1000,10000",
    f"humanoid on the floor={MODELS}benchmark__humanoid.xml,1000,8000",
    f"27 boxes piled={BENCH}boxes27.xml,1000,2000",
]
PAIRS = 9


def cpu_seconds(command):
    """Processor time of a program."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"{command} failed")
    return used.ru_utime + used.ru_stime


def collected(command, function):
    """Instructions inside a function."""
    out = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--toggle-collect={function}",
                          *command], capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", out.stderr).group(1))


def ours(model, warm, steps, full):
    return [OURS, "bench", model, "--warm", str(warm), "--steps", str(steps), "--repeat", "1", *(["--full"] if full else [])]


def theirs(bench, model, warm, steps):
    return [bench, model, str(steps), str(warm), "1"]


def step_ns(command, steps):
    """Nanoseconds per step of a program that takes the number of steps."""
    few = steps // 10
    return 1e9 * (cpu_seconds(command(steps)) - cpu_seconds(command(few))) / (steps - few)


def measure(bench, name, model, warm=100, steps=20000):
    """A line of the table."""
    planned, every, library = (lambda n: ours(model, warm, n, False)), (lambda n: ours(model, warm, n, True)), (
        lambda n: theirs(bench, model, warm, n))
    # Theirs steps twice as often: once more for its statistics, up to 20,000 of them.
    twice = lambda n: (n + min(n, 20000)) / n
    rounds = []
    for _ in range(PAIRS):
        a, b = step_ns(planned, steps), step_ns(every, steps)
        few = steps // 10
        c = 1e9 * (cpu_seconds(library(steps)) - cpu_seconds(library(few))) / (steps * twice(steps) - few * twice(few))
        rounds.append((a, b, c, c / a, c / b))
    a, b, c, planned_ratio, every_ratio = (statistics.median(column) for column in zip(*rounds))
    cells = [name, f"{b:.0f}", f"{a:.0f}", f"{c:.0f}", f"1/{every_ratio:.1f}", f"1/{planned_ratio:.1f}"]
    if shutil.which("valgrind"):
        n = 200
        i, k = collected(planned(n), ADVANCE) / n, collected(every(n), ADVANCE) / n
        j = (collected(library(2 * n), "mj_step") - collected(library(n), "mj_step")) / (2 * n)
        cells += [f"{k:.0f}", f"{i:.0f}", f"{j:.0f}", f"1/{j / k:.1f}", f"1/{j / i:.1f}"]
    return cells


# Scenes that show what the tree algorithms are worth, with warm-up steps.
WAY_SCENES = [
    ("free fall", "../shared/corpus/models/free_fall.xml", 100),
    ("two balls at rest", "../shared/corpus/models/ball_drop.xml", 2000),
    ("pendulum", f"{BENCH}pendulum.xml", 100),
    ("cart and pole", f"{BENCH}cartpole.xml", 100),
    ("gripper", "../shared/corpus/models/gripper.xml", 1000),
    ("gantry with a gripper", "../shared/corpus/models/gantry_gripper.xml", 1000),
    ("gantry, contacts off", "../shared/corpus/models/gantry_gripper.xml", 100),
    ("joints of every kind", "../shared/corpus/models/joint_zoo.xml", 100),
    ("arm of two", "../shared/corpus/models/arm2.xml", 100),
    ("humanoid, contacts off", f"{MODELS}mjx__humanoid__humanoid.xml", 100),
    ("humanoid on the floor", f"{MODELS}benchmark__humanoid.xml", 1000),
    ("chain of 100 hinges", f"{BENCH}chain100.xml", 100),
    ("27 boxes piled", f"{BENCH}boxes27.xml", 1000),
]


def tree_algorithms():
    """The names that `--without` takes: those of the program's own table."""
    text = subprocess.run([OURS, "bench", "-h"], capture_output=True, text=True, check=True).stdout
    return re.search(r"--without [^\[]*\[possible values: ([^\]]*)\]", " ".join(text.split())).group(1).split(", ")


def ablation(folder):
    """What a step costs without each tree algorithm, in times of what it costs with all of them: instructions."""
    algorithms = tree_algorithms()
    lines = ["| scene | " + " | ".join(f"without {one}" for one in algorithms) + " | without any |",
             "|---" + "|---:" * (len(algorithms) + 1) + "|"]
    for name, model, warm in WAY_SCENES:
        model = switched(model, "contact", folder) if "contacts off" in name else model
        cost = lambda without: collected(
            ours(model, warm, 200, False) + [x for name in without for x in ("--without", name)], ADVANCE) / 200
        best = cost([])
        ratios = [cost([one]) / best for one in algorithms] + [cost(algorithms) / best]
        lines.append("| " + " | ".join([name] + ["" if r < 1.005 else f"{r:.2f}" for r in ratios]) + " |")
        print(lines[-1], flush=True)
    return "\n".join(lines)


# Scenes whose profile is shown: with warm-up steps, what is switched off, whether every field is computed.
PROFILES = [
    ("free fall", "../shared/corpus/models/free_fall.xml", 100, None, False),
    ("two balls at rest", "../shared/corpus/models/ball_drop.xml", 2000, None, False),
    ("humanoid on the floor", f"{MODELS}benchmark__humanoid.xml", 1000, None, False),
    ("humanoid on the floor, every field", f"{MODELS}benchmark__humanoid.xml", 1000, None, True),
    ("humanoid, constraints off, every field", f"{MODELS}benchmark__humanoid.xml", 100, "constraint", True),
    ("humanoid, contacts off, every field", f"{MODELS}mjx__humanoid__humanoid.xml", 100, "contact", True),
    ("gripper, every field", "../shared/corpus/models/gripper.xml", 1000, None, True),
]


def profiles(folder):
    """Which functions the instructions of a step are in, the largest seven."""
    lines = ["| scene | instructions | where |", "|---|---:|---|"]
    for name, model, warm, off, full in PROFILES:
        model = switched(model, off, folder) if off else model
        out = f"{folder}/profile"
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", f"--toggle-collect={ADVANCE}",
                        *ours(model, warm, 200, full)], capture_output=True, check=True)
        text = subprocess.run(["callgrind_annotate", "--threshold=100", out], capture_output=True, text=True, check=True).stdout
        own = {}
        for count, function in re.findall(r"^\s*([\d,]+) \([^)]*\)\s+\S*?:((?:labspec|<|core|alloc|libm|__|mem)\S.*?)(?: \[.*)?$", text, re.M):
            function = re.sub(r"'\d+$", "", function)
            short = re.sub(r"::\{closure[^}]*\}|::h[0-9a-f]{16}|labspec_core::|<impl [^>]*>::", "", function).strip()
            own[short] = own.get(short, 0) + int(count.replace(",", "")) / 200
        total = sum(own.values())
        parts = ", ".join(f"`{f}` {100 * n / total:.0f} %" for f, n in sorted(own.items(), key=lambda x: -x[1])[:7])
        lines.append(f"| {name} | {total:.0f} | {parts} |")
        print(lines[-1], flush=True)
    return "\n".join(lines)


def switched(model, off, folder):
    """A copy of a model with something switched off."""
    text = pathlib.Path(model).read_text()
    text = re.sub(r"(<mujoco[^>]*>)", rf'\1<option><flag {off}="disable"/></option>', text, count=1)
    # What it attaches lies beside it.
    for attached in re.findall(r'<model[^>]*file="([^"]+)"', text):
        shutil.copy(pathlib.Path(model).parent / attached, folder)
    copy = pathlib.Path(folder) / pathlib.Path(model).name
    copy.write_text(text)
    return str(copy)


def processor():
    info = pathlib.Path("/proc/cpuinfo")
    found = re.search(r"model name\s*: (.*)", info.read_text()) if info.exists() else None
    return found.group(1) if found else "an unknown processor"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("bench")
    p.add_argument("scenes", nargs="*")
    p.add_argument("--out", type=pathlib.Path)
    p.add_argument("--algorithms", action="store_true", help="write only the tables of tree algorithms and profiles; the first table in --out is kept")
    a = p.parse_intermixed_args()
    heads = ["scene", "every field, ns", "planned, ns", "MuJoCo, ns", "ratio", "planned"]
    if shutil.which("valgrind"):
        heads += ["every field, instructions", "planned", "MuJoCo", "ratio", "planned"]
    lines = ["| " + " | ".join(heads) + " |", "|---" + "|---:" * (len(heads) - 1) + "|"]
    with tempfile.TemporaryDirectory() as folder:
        if a.algorithms:
            old = a.out.read_text()
            lines = [line for line in old.split("\n## ")[0].split("\n") if line.startswith("|")]
            processor_of = re.search(r"measured on (.*) by", old).group(1)
        for scene in [] if a.algorithms else a.scenes or SCENES:
            name, rest = scene.split("=", 1)
            model, *numbers = rest.split(",")
            off = numbers.pop() if numbers and not numbers[-1].isdigit() else None
            model = switched(model, off, folder) if off else model
            lines.append("| " + " | ".join(measure(a.bench, name, model, *map(int, numbers))) + " |")
            print(lines[-1], flush=True)
        counted = a.out and shutil.which("valgrind")
        profile, algorithms = (profiles(folder), ablation(folder)) if counted else ("", "")
    if a.out:
        where = processor_of if a.algorithms else processor()
        # What is written by hand stays: the reasons after the profiles. What other programs measure stays, too: the labs before
        # the tree algorithms, the checks at the end.
        old = a.out.read_text() if a.out.exists() else ""
        reasons = re.search(r"\n## Profiles\n.*?\n\|[^\n]*\n\n(.*?)\n*(?=\n## |\Z)", old, re.S)
        page = PAGE.format(processor=where, table="\n".join(lines), algorithms=algorithms, profile=profile,
                           reasons=reasons.group(1) if reasons else "")
        labs = re.search(r"\n## Kinds of labs\n.*?(?=\n## Tree algorithms)", old, re.S)
        if labs:
            page = page.replace("\n## Tree algorithms", labs.group(0) + "\n## Tree algorithms", 1)
        _, mark, rest = old.partition("\n## Checks\n")
        a.out.write_text(page.rstrip("\n") + "\n" + mark + rest)
    return 0


PAGE = """# Speed

This page compares the cost of one step with MuJoCo 3.14.0, measured on {processor} by

    cargo build --release -p labspec-cli
    tests/speed/compare.py BENCH_MUJOCO --out docs/measured/speed.md

{table}

*Every field* computes all readable fields in every step (`labspec bench --full`), as MuJoCo does; its ratio is the primary one.
*Planned* is a lab that reads the state alone. Times are processor times, medians of pairs of runs in alternation. Instructions
are counted by callgrind and repeat to within a few.

Causes of the difference:

* Forces and inertias of four bodies are computed in the SIMD lanes of a vector (`math/lanes.rs`), frames as columns of vectors.
* M and its factorization are computed only in steps in which constraints act, if nothing else reads them.
* Trees of at most six slides and hinges have their equations of motion in closed form (`dynamics/tree_algorithms/chain/`), without spatial bodies.
* Larger trees are factorized as articulated bodies (`dynamics/tree_algorithms/articulated.rs`): the time grows with the number of bodies, not with
  the square of the depth, and the implicit damping of Euler's method costs one more pass instead of one more factorization of M.
* Rows of M and of its factorization are products along the path to the root, eight columns at a time (`dynamics/path.rs`).
* The Hessian of the constraints is stored and factorized in blocks of four by four (`constraint/hessian.rs`); constraints add to the blocks
  of their columns. The Hessian of a single free body is a matrix of six by six on the stack (`constraint/six.rs`).
* A pair of geoms whose bounding spheres are apart costs one comparison with a number that is known when the plan is made.
* Features that a scene does not use cost nothing (`labspec plan`).

## Tree algorithms

The table shows the cost of a planned step without one specialized tree algorithm, relative to its cost with all of them, in
instructions. A cell is empty if the scene does not use the algorithm. `dynamics/tree_algorithms/` documents the algorithms,
`labspec bench --without ALGORITHM` measures a scene, and `tests/tree_algorithms.rs` compares each with the general algorithm.

{algorithms}

## Profiles

The table shows scenes that missed a target of the project (every field: half of MuJoCo's instructions; planned: humanoid on the floor a
half, two balls 1/6, free fall 500), and the functions that execute their instructions (callgrind, own instructions of a step by function,
the largest seven; inlined code counts for its caller):

{profile}

{reasons}
"""

if __name__ == "__main__":
    sys.exit(main())
