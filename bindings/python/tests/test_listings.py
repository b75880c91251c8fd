"""The listings of lesson 0.1, which need MuJoCo: right outputs pass, and every changed digit is found.

The lesson is read where it is shared. It contains the outputs of its two listings; the programs below are ours. All copies with a changed digit
are checked by one run of the program, which runs each distinct listing once: both tests together take some seconds.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import listing_settings, needs

SHARED = next((folder / "shared" for folder in Path(__file__).resolve().parents if (folder / "shared/lesson-0.1").is_dir()), None)

FREE_FALL = """\
import mujoco

G, START, END = 9.81, 1.0, 0.3
for h in (0.0005, 0.001, 0.002, 0.005, 0.01):
    model = mujoco.MjModel.from_xml_path("models/free_fall.xml")
    model.opt.timestep = h
    data = mujoco.MjData(model)
    while data.time < END - h / 2:
        mujoco.mj_step(model, data)
    error = data.qpos[2] - (START - 0.5 * G * data.time**2)
    print(f"{h:.4f} {1000 * error:.4f} {-500 * G * h * data.time:.4f}")
"""

BALL_DROP = """\
import math
import mujoco

G, FALL, RADIUS = 9.81, 0.95, 0.05
print(f"analytic: t = {math.sqrt(2 * FALL / G):.4f} s, v = {math.sqrt(2 * G * FALL):.3f} m/s")
model = mujoco.MjModel.from_xml_path("models/ball_drop.xml")
data = mujoco.MjData(model)
names = ("heavy", "light")
reported = set()
while len(reported) < 2:
    time, speed = data.time, {name: -data.joint(f"{name}_free").qvel[2] for name in names}
    mujoco.mj_step(model, data)
    pairs = [{model.geom(g).name for g in (c.geom1, c.geom2)} for c in data.contact]
    for name in names:
        if name not in reported and {f"{name}_geom", "floor"} in pairs:
            reported.add(name)
            print(f"{name}: t = {time:.4f} s, v = {speed[name]:.3f} m/s")
for _ in range(1500):
    mujoco.mj_step(model, data)
for name in names:
    z = data.body(name).xpos[2]
    print(f"{name} at rest: centre z = {z:.5f} m, penetration = {1000 * (RADIUS - z):.3f} mm")
"""


def lesson_with_programs() -> str:
    """The lesson with a program above each output, without its labs and quizzes, which other tests check."""
    text = (SHARED / "lesson-0.1/lesson-0.1.md").read_text(encoding="utf-8")
    text = re.sub(r"^```(?:lab simlab|quiz)\n.*?^```\n", "", text, flags=re.DOTALL | re.MULTILINE)
    for name, program in (("l0_1_free_fall", FREE_FALL), ("l0_1_ball_drop", BALL_DROP)):
        text, n = re.subn(rf"^Listing: `examples/{name}\.py`.*$", lambda _: f"```python file=examples/{name}.py\n{program}```", text, flags=re.MULTILINE)
        assert n == 1, name
    return text


def output_digits(text: str) -> list[int]:
    """The characters of the lesson that are digits of an output: of the fence `text`, and of the body of the table."""
    outputs = [*re.finditer(r"^```text\n(.*?)^```$", text, re.DOTALL | re.MULTILINE), *re.finditer(r"^\|-.*\n((?:\|.*\n)+)", text, re.MULTILINE)]
    return [output.start(1) + i for output in outputs for i, c in enumerate(output[1]) if c.isdigit()]


@pytest.fixture
def folder(tmp_path):
    """A folder with the models and the settings of the lesson."""
    needs("mujoco")
    if SHARED is None:
        if os.environ.get("LABSPEC_REQUIRE") == "all":
            pytest.fail("the shared lesson is not there")
        pytest.skip("the shared lesson is not there")
    shutil.copytree(SHARED / "corpus/models", tmp_path / "models")
    settings = listing_settings(f"python = {json.dumps(sys.executable)}", 'files = ["models"]')
    (tmp_path / "labspec.toml").write_text(settings, encoding="utf-8")
    return tmp_path


def check(folder: Path) -> tuple[int, dict]:
    command = [sys.executable, "-m", "labspec", "check", *sorted(path.name for path in folder.glob("*.md")), "--listings", "--format", "json"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, env={**os.environ, "LABSPEC_CACHE": ""}, check=False)
    assert result.returncode in (0, 1), result.stderr
    return result.returncode, json.loads(result.stdout)


def test_the_displayed_outputs_are_right(folder):
    (folder / "lesson.md").write_text(lesson_with_programs(), encoding="utf-8")
    _, report = check(folder)
    count = report["summary"]["claims"]["listing"]
    assert (count["simulated"], count["false"], count["unchecked"]) == (2, 0, 0), report["findings"]
    assert not [f for f in report["findings"] if f["code"].startswith("listing-")]


def test_every_changed_digit_is_found(folder):
    text = lesson_with_programs()
    places = output_digits(text)
    assert len(places) > 120
    planted = {}
    for i, at in enumerate(places):
        wrong = f"{text[:at]}{(int(text[at]) + 1) % 10}{text[at + 1:]}"
        planted[f"wrong-{i:03}.md"] = len(text[:at].encode()), wrong.encode()
    for name, (_, wrong) in planted.items():
        (folder / name).write_bytes(wrong)
    code, report = check(folder)
    assert code == 1
    found = [f for f in report["findings"] if f["code"].startswith("listing-")]
    for finding in found:
        at, wrong = planted.pop(finding["file"])
        assert finding["code"] == "listing-output" and finding["start"] <= at < finding["end"], finding
        assert not re.search(rb"\s", wrong[finding["start"] : finding["end"]]), finding
    assert not planted, f"changes without a finding: {sorted(planted)}"
    assert report["summary"]["claims"]["listing"]["false"] == len(found)
