#!/usr/bin/env python3
"""Time of a step, ours beside MuJoCo's, in the same run; and instructions per step, which repeat.

    cargo build --release -p labspec
    tests/speed/compare.py BENCH_MUJOCO NAME=MODEL.xml[,warm[,steps]]...

BENCH_MUJOCO is the program made from `bench_mujoco.c` of the oracle. Runs alternate, ours and theirs; the ratio is
that of medians. Instructions are counted by valgrind's callgrind, ours from the measured steps alone, theirs inside
mj_step, from two runs of different length. Prints a Markdown table. Needs Python 3.9 or newer.
"""
import json, re, statistics, subprocess, sys

OURS = "target/release/labspec"
ADVANCE = "labspec::cli::bench::advance"


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True)


def ours_ns(model, warm, steps, full):
    out = run(OURS, "bench", model, "--warm", str(warm), "--steps", str(steps), "--repeat", "1", *full)
    return json.loads(out.stdout)["median_ns"]


def theirs_ns(bench, model, warm, steps):
    out = run(bench, model, str(steps), str(warm), "1")
    return float(re.search(r"median\s+([\d.]+)", out.stdout).group(1))


def collected(*command):
    out = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command)
    return int(re.search(r"Collected : (\d+)", out.stderr).group(1))


def ours_instructions(model, warm, full):
    out = collected(f"--toggle-collect={ADVANCE}", OURS, "bench", model, "--warm", str(warm), "--steps", "2000", "--repeat", "1", *full)
    return out / 2000


def theirs_instructions(bench, model, warm):
    # The statistics run of the program steps once more for the warm-up and for every step.
    count = lambda steps: collected("--toggle-collect=mj_step", bench, model, str(steps), str(warm), "1")
    return (count(2000) - count(1000)) / 2000


def main(argv):
    if len(argv) < 2:
        print(__doc__)
        return 2
    bench, cases = argv[0], argv[1:]
    print("| scene | ours, ns per step | all fields | MuJoCo | ratio | ours, instructions | all fields | MuJoCo | ratio |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for case in cases:
        name, rest = case.split("=", 1)
        model, *numbers = rest.split(",")
        warm = int(numbers[0]) if numbers else 1000
        steps = int(numbers[1]) if len(numbers) > 1 else 20000
        a, f, b = [], [], []
        for _ in range(9):
            a.append(ours_ns(model, warm, steps, []))
            b.append(theirs_ns(bench, model, warm, steps))
            f.append(ours_ns(model, warm, steps, ["--full"]))
        x, z, y = statistics.median(a), statistics.median(f), statistics.median(b)
        i, k, j = ours_instructions(model, warm, []), ours_instructions(model, warm, ["--full"]), theirs_instructions(bench, model, warm)
        print(f"| {name} | {x:.0f} | {z:.0f} | {y:.0f} | 1/{y / x:.1f} | {i:.0f} | {k:.0f} | {j:.0f} | 1/{j / i:.1f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
