"""Labs in notebooks: the side of Python."""

import os
from pathlib import Path

import pytest
from conftest import needs

import labspec

SPECS = Path(__file__).resolve().parents[3] / "specs"
LAB = {"model": "ball", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}
BALL = "<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"
SCRIPT = "export default { render({ model, el }) { el.textContent = model.get('lab').title } }"


@pytest.fixture
def script(tmp_path):
    needs("anywidget")
    path = tmp_path / "labspec-elements.js"
    path.write_text(SCRIPT, encoding="utf-8")
    return path


def test_a_lab_is_shown_with_its_models(script):
    widget = labspec.show(labspec.Lab(LAB, {"ball": BALL}), esm=script)
    assert widget.lab == LAB and widget.models == {"ball": BALL} and widget._esm == SCRIPT
    assert {"lab", "models", "_esm"} <= set(widget.keys)
    assert widget.get_state(["lab"])["lab"] == LAB


def test_the_script_is_named_by_the_environment(script, monkeypatch):
    monkeypatch.setenv("LABSPEC_ELEMENTS", os.fspath(script))
    widget = labspec.show(labspec.Lab(f"{SPECS / 'lessons/02-bounce-and-swing.md'}#1"))
    assert widget._esm == SCRIPT and list(widget.models) == ["bounce"] and "<mujoco" in widget.models["bounce"]


def test_without_a_script_the_error_says_what_to_build(script, monkeypatch):
    lab = labspec.Lab(LAB, {"ball": BALL})
    with pytest.raises(FileNotFoundError, match="npm run build"):
        labspec.show(lab, esm=script.with_name("nothing.js"))


def test_files_outside_of_the_folder_are_not_sent(script, tmp_path):
    folder = tmp_path / "models"
    folder.mkdir()
    (tmp_path / "secret.xml").write_text("<mujocoinclude/>", encoding="utf-8")
    (folder / "part.xml").write_text("<mujocoinclude><body name='b' pos='0 0 1'><geom size='1'/></body></mujocoinclude>", encoding="utf-8")
    model = "<mujoco><!-- file='../secret.xml' --><worldbody><include file='part.xml'/></worldbody></mujoco>"
    (folder / "ball.xml").write_text(model, encoding="utf-8")
    widget = labspec.show(labspec.Lab({"model": "ball"}, folder), esm=script)
    assert sorted(widget.models) == ["ball", "part"] and "mujocoinclude" in widget.models["part"]
    opened = labspec.Lab({"model": "ball"}, widget.models)
    assert opened.model.nbody == 2


def test_meshes_are_sent_as_buffers(script, tmp_path):
    remove = needs("ipywidgets.widgets.widget")._remove_buffers
    models = tmp_path / "models"
    (models / "shapes").mkdir(parents=True)
    wedge = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (models / "shapes/wedge.obj").write_bytes(wedge)
    text = (
        "<mujoco><compiler meshdir='shapes'/><asset><mesh name='wedge' file='wedge.obj'/></asset>"
        "<worldbody><body><freejoint/><geom type='mesh' mesh='wedge'/></body></worldbody></mujoco>"
    )
    (models / "solid.xml").write_text(text, encoding="utf-8")
    lab = labspec.Lab({"model": "solid"}, models)
    assert lab.model.nmesh == 1
    widget = labspec.show(lab, esm=script)
    assert widget.models == {"solid": text, "shapes/wedge.obj": wedge}
    # The page gets these bytes as a `DataView` of the message; the widget of web/elements takes them.
    state, paths, buffers = remove(widget.get_state())
    assert paths == [["models", "shapes/wedge.obj"]] and [bytes(b) for b in buffers] == [wedge]
    assert state["models"] == {"solid": text}
