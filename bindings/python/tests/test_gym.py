"""Labs as environments of Gymnasium."""

import math

import numpy as np
import pytest
from conftest import needs

import labspec

CART = {
    "xml": "<mujoco><option timestep='0.01'/><worldbody><body name='cart'><joint name='rail' type='slide' axis='1 0 0' range='-2 2' limited='true'/><geom size='.1'/>"
    "<body name='pole'><joint name='hinge' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0 0 .6' size='.04'/></body></body></worldbody>"
    "<actuator><motor name='push' joint='rail' ctrllimited='true' ctrlrange='-3 5' gear='10'/></actuator></mujoco>",
    "setup": "data.qpos[1] = 0.05",
    "controls": [
        {"label": "mass", "set": "model.body_mass[2]", "min": 0.5, "max": 2, "step": 0.25, "value": 1, "reset": True},
        {"label": "push", "set": "data.ctrl[0]", "min": -2, "max": 2, "step": 0.1, "value": 0, "init": True},
        {"type": "button", "label": "kick", "run": "data.qvel[0] += 1"},
    ],
    "readouts": [{"label": "angle (deg)", "expr": "lib.deg(data.qpos[1])"}, {"label": "state", "expr": "data.qpos[1] > 0.2 ? 'falls' : 'stands'"}],
}
PARTS = {"reward": "1 - Math.abs(data.qpos[1])", "terminated": "Math.abs(data.qpos[1]) > 0.5"}


@pytest.fixture
def gym():
    needs("gymnasium")
    import labspec.gym

    return labspec.gym


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"actions": ["push"], "observations": ["angle (deg)"], "frame_skip": 5},
        {"randomize": ["mass"], "until": 0.5},
    ],
)
def test_the_checker_of_gymnasium_accepts_it(gym, more):
    from gymnasium.utils.env_checker import check_env

    check_env(gym.LabEnv(labspec.Lab(CART), **PARTS, **more), skip_render_check=True)


def test_an_episode_is_the_run_of_the_lab(gym):
    env = gym.LabEnv(labspec.Lab(CART), **PARTS, until=0.2)
    assert env.action_space.low.tolist() == [-3] and env.action_space.high.tolist() == [5]
    observation, _info = env.reset(seed=1)
    assert list(env.observed) == ["qpos[0]", "qpos[1]", "qvel[0]", "qvel[1]"] and observation.tolist() == [0, 0.05, 0, 0]
    data = labspec.Data(labspec.Lab(CART).model)
    data.qpos[1] = 0.05
    data.forward()
    for _ in range(20):
        observation, reward, terminated, truncated, info = env.step(np.array([2.5], np.float32))
        data.ctrl[0] = 2.5
        data.step()
        assert observation == pytest.approx(np.concatenate([data.qpos, data.qvel]), rel=1e-5, abs=1e-7)
        assert reward == 1 - abs(observation[1]) and terminated == (abs(observation[1]) > 0.5)
        if terminated:
            break
    assert truncated == (info["time"] >= 0.2 - 1e-9)
    again, _info = env.reset()
    assert again.tolist() == [0, 0.05, 0, 0] and env.lab.time == 0


def test_resets_draw_and_set_controls(gym):
    env = gym.LabEnv(labspec.Lab(CART), **PARTS, randomize=["mass"])
    masses = []
    for seed in (1, 2, 3, 1):
        env.reset(seed=seed)
        masses.append(env.lab["mass"])
    assert masses[0] == masses[3] and len(set(masses)) > 1 and all(m in np.arange(0.5, 2.1, 0.25) for m in masses)
    env.reset(options={"set": {"mass": 2}})
    assert env.lab["mass"] == 2 and env.lab.field("body_mass")[2] == 2
    with pytest.raises(KeyError, match="nothing"):
        env.reset(options={"set": {"nothing": 2}})


def test_what_is_no_number_ends_the_episode(gym):
    env = gym.LabEnv(labspec.Lab(CART), reward="data.time > 0.015 ? NaN : 1", observations=["angle (deg)", "state"])
    observation, info = env.reset()
    assert info["not_finite"] == ["state"] and observation[1] == 0
    env = gym.LabEnv(labspec.Lab(CART), reward="data.time > 0.015 ? NaN : 1")
    env.reset()
    assert env.step(env.action_space.low)[1:3] == (1.0, False)
    _observation, reward, terminated, _truncated, info = env.step(env.action_space.low)
    assert reward == 0 and terminated and info["not_finite"] == ["reward"]
    for wrong in ([math.nan], [1, 2], []):
        with pytest.raises(ValueError, match="finite numbers"):
            env.step(np.array(wrong, np.float32))


def test_impossible_environments_are_refused(gym):
    lab = labspec.Lab(CART)
    with pytest.raises(labspec.LabspecError, match="qpso") as caught:
        gym.LabEnv(lab, reward="data.qpso[0]")
    assert caught.value.findings
    for more, kind in [
        ({"actions": ["kick"]}, KeyError),
        ({"actions": ["nothing"]}, KeyError),
        ({"observations": ["nothing"]}, KeyError),
        ({"frame_skip": 0}, ValueError),
        ({"actions": "all"}, ValueError),
        ({"actions": []}, ValueError),
    ]:
        with pytest.raises(kind):
            gym.LabEnv(lab, **PARTS, **more)
