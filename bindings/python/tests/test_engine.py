"""Models and data: views of memory, named access, errors."""

import gc
import pickle
import threading

import numpy as np
import pytest

import labspec

BALL = """<mujoco model="ball"><worldbody><geom name="floor" type="plane" size="5 5 1"/>
<body name="ball" pos="0 0 1"><freejoint name="fall"/><geom name="ball" size="0.1" mass="2"/></body>
<body name="arm" pos="2 0 1"><joint name="hinge" axis="0 1 0" damping="0.1"/><geom size="0.1" pos="0.5 0 0"/></body></worldbody>
<actuator><motor name="motor" joint="hinge"/></actuator><sensor><jointpos name="angle" joint="hinge"/></sensor>
<keyframe><key name="high" qpos="0 0 3 1 0 0 0 0.5"/></keyframe></mujoco>"""


@pytest.fixture
def model():
    return labspec.Model.from_xml(BALL)


@pytest.fixture
def data(model):
    return labspec.Data(model)


def test_fields_show_memory(model, data):
    qpos = data.qpos
    assert qpos.shape == (8,) and qpos[2] == 1
    data.step(10)
    assert qpos[2] < 1, "the array shows the state after the step"
    qpos[2] = 5
    data.step()
    assert 4.99 < data.qpos[2] < 5
    assert np.shares_memory(qpos, data.qpos)
    assert data.xpos.shape == (3, 3) and data.time > 0 and model.nq == 8


def test_arrays_are_taken_once(data):
    then = data.save()
    qpos = data.qpos
    assert data.qpos is qpos and data.xpos is data.xpos
    data.step(3)
    data.reset()
    data.forward()
    assert data.qpos is qpos and qpos[2] == 1
    data.qpos = np.arange(8)
    assert data.qpos is qpos and qpos[1] == 1
    data.restore(then)
    assert data.qpos is not qpos and data.qpos[2] == 1
    assert data.ncon == 0 and data.time == 0 and not set(vars(data)) & {"ncon", "time"}


def test_objects_have_whole_numbers(data):
    assert data.body(np.int32(1)).name == "ball" and data.body(1).id == 1
    for wrong, kind in ((3, IndexError), (-1, IndexError), (1.5, TypeError), (None, TypeError)):
        with pytest.raises(kind):
            data.body(wrong)


def test_what_follows_from_other_fields_is_read_only(data):
    with pytest.raises(ValueError, match="read-only"):
        data.xpos[0, 0] = 1
    with pytest.raises(labspec.LabspecError, match="xpos") as caught:
        data.xpos = [0] * 9
    assert caught.value.code == "not-writable"


def test_views_outlive_their_owner(model):
    qpos = labspec.Data(model).qpos
    mass = labspec.Model.from_xml(BALL).body_mass
    gc.collect()
    junk = [labspec.Data(model) for _ in range(50)]
    assert qpos[2] == 1 and mass[1] == 2 and len(junk) == 50


def test_what_is_written_to_a_model_is_used(model, data):
    data.step(100)
    fallen = 1 - data.qpos[2]
    model.opt.gravity[2] = 0
    data.reset()
    data.step(100)
    assert data.qpos[2] == 1 and fallen > 0.1
    model.opt.timestep = 0.001
    assert model.opt.timestep == 0.001
    # The mass of a body is a constant from which others follow.
    model.body_mass[1] = 4
    data.set_const()
    assert model.body_subtreemass[0] == pytest.approx(4 + model.body_mass[2])


def test_objects_have_names(model, data):
    data.forward()
    assert np.array_equal(data.body("ball").xpos, [0, 0, 1])
    assert data.joint("fall").qpos.shape == (7,) and data.joint("hinge").qpos.shape == (1,)
    data.joint("hinge").qpos = 0.25
    data.actuator("motor").ctrl = 1
    data.step()
    assert data.sensor("angle").data[0] == pytest.approx(0.25, abs=0.01)
    assert model.geom("ball").size[0] == 0.1 and model.joint("hinge").damping[0] == 0.1
    assert model.body("ball").id == 1 and model.body(1).name == "ball"
    with pytest.raises(KeyError, match='did you mean "ball"'):
        data.body("bal")
    with pytest.raises(AttributeError, match="a body has no field `xpso`"):
        data.body("ball").xpso
    with pytest.raises(AttributeError, match="did you mean `qpos`"):
        data.qpso


def test_states_come_back(model, data):
    data.step(10)
    saved = data.save()
    data.step(90)
    first = data.qpos.copy()
    before = data.qpos
    data.restore(saved)
    data.step(90)
    gc.collect()
    assert before.tobytes() == first.tobytes() and not np.shares_memory(before, data.qpos)
    assert first.tobytes() == data.qpos.tobytes()
    with pytest.raises(labspec.LabspecError):
        data.restore(saved[:-1])
    data.reset("high")
    assert data.qpos[2] == 3 and data.qpos[7] == 0.5
    again = pickle.loads(pickle.dumps(data))
    again.step(10), data.step(10)
    assert again.qpos.tobytes() == data.qpos.tobytes()


def test_mistakes_have_findings():
    with pytest.raises(labspec.LabspecError) as caught:
        labspec.Model.from_xml("<mujoco><worldbody><body><goem/></body></worldbody></mujoco>")
    finding = caught.value.findings[0]
    assert finding["line"] == 1 and "geom" in finding["help"]
    with pytest.raises(labspec.LabspecError):
        labspec.Model.from_file("/nowhere/at-all.xml")
    with pytest.raises(ValueError, match="has 8 numbers, not 3"):
        labspec.Data(labspec.Model.from_xml(BALL)).qpos = [1, 2, 3]
    with pytest.raises(TypeError):
        labspec.Model(BALL)


def test_an_error_in_a_thread_blocks_no_other(model):
    data = [labspec.Data(model) for _ in range(2)]

    def fail(one):
        for _ in range(300):
            with pytest.raises(labspec.LabspecError):
                one.restore(b"no data")

    threads = [threading.Thread(target=fail, args=(one,)) for one in data]
    [thread.start() for thread in threads]
    for _ in range(3000):
        assert model.body_mass[1] == 2
        model.body_mass = list(model.body_mass)
    [thread.join(60) for thread in threads]
    assert not any(thread.is_alive() for thread in threads)


def test_threads_step_their_own_data(model):
    alone = labspec.Data(model)
    alone.step(2000)
    all_data = [labspec.Data(model) for _ in range(4)]
    threads = [threading.Thread(target=data.step, args=(2000,)) for data in all_data]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(data.qpos.tobytes() == alone.qpos.tobytes() for data in all_data)
