"""What a notebook displays: every text of a lesson is escaped, and plots are pictures in which nothing runs."""

import base64
import re
from html.parser import HTMLParser

import labspec

EVIL = "</td></svg><script>alert(1)</script>\"'&<img src=x onerror=alert(1)>"
LAB = {
    "title": EVIL,
    "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
    "stopAt": 0.2,
    "controls": [
        {"label": EVIL, "unit": EVIL, "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": True},
        {"type": "select", "label": "kind", "param": "kind", "options": [[EVIL, EVIL], ["b", "b"]], "value": EVIL},
    ],
    "plots": [{"ylabel": EVIL, "refLines": [{"y": 0.9, "label": EVIL}], "traces": [{"label": EVIL, "expr": "data.qpos[2]"}]}],
    "readouts": [{"label": f"{EVIL} (m)", "expr": "data.qpos[2]"}, {"label": "text", "expr": "ctx.kind"}],
}
ALLOWED = {"p", "strong", "small", "table", "thead", "tbody", "tr", "th", "td", "img"}


class Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.found, self.pictures = [], []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        assert tag in ALLOWED, tag
        assert set(attributes) <= ({"alt", "src", "style"} if tag == "img" else set()), attributes
        self.found.append(tag)
        if tag == "img":
            kind, _, content = attributes["src"].partition(",")
            assert kind == "data:image/svg+xml;base64"
            self.pictures.append(base64.b64decode(content).decode())


def tags(value):
    found = Tags()
    found.feed(value._repr_html_())
    found.close()
    for svg in found.pictures:
        assert "<script" not in svg and "<img" not in svg and not re.search(r"<[^>]*\son\w+=", svg)
    return found


def test_a_lab_displays_its_plots_controls_and_readouts():
    lab = labspec.Lab(LAB)
    lab.step(5)
    found = tags(lab)
    assert len(found.pictures) == 1 and found.found.count("table") == 2
    assert lab.time == 5 * lab.timestep, "the lab is where it was"


def test_recordings_are_drawn_as_the_program_draws_them(program, tmp_path):
    import json
    import subprocess

    lab = labspec.Lab(LAB)
    recording = lab.record(until=0.2)
    file = tmp_path / "lab.json"
    file.write_text(json.dumps(LAB), encoding="utf-8")
    subprocess.run([program, "run", file, "--until", "0.2", "--svg", tmp_path / "plot.svg"], check=True, capture_output=True)
    assert recording.plots() == ((tmp_path / "plot.svg").read_text(encoding="utf-8"),)
    assert len(tags(recording).pictures) == 1


def test_reports_are_tables():
    lesson = f'# {EVIL}\n\n```lab simlab\n{{"xml": "<mujoco/>", "readouts": [{{"label": "x", "expr": "data.qpso"}}]}}\n```\n'
    report = labspec.check("lesson.md", text=lesson)
    assert not report and "table" in tags(report).found
    lab = labspec.Lab(LAB)
    verified = lab.verify({"measure": {"end": "final(data.qpos[2])"}})
    assert "table" in tags(verified).found
    assert "table" in tags(labspec.sweep(lab, {EVIL: [-5, -10]}, {"end": "final(data.qpos[2])"})).found
    precision = lab.precision(integrators=["Euler"])
    assert len(tags(precision).pictures) == 1
    tags(lab.stability(until=0.1))


def test_a_broken_lab_still_displays():
    lab = labspec.Lab({**LAB, "controller": "data.qvel[data.time > 0.1 ? -1 : 0] = ctx.nothing.x"})
    assert "table" in tags(lab).found


def test_labs_with_wrong_values_display_or_are_refused():
    weird = [None, True, -1, 0, 1e308, 10**400, "5", [], {}, [[]], [{"window": 1e308, "traces": []}], [{"window": "x"}], [5]]
    for key in ("plots", "stopAt", "readouts", "controls", "title", "kind", "note"):
        for value in weird:
            try:
                lab = labspec.Lab({**LAB, key: value})
            except labspec.LabspecError:
                continue
            tags(lab)
