"""A lab as an environment of Gymnasium: ``labspec.gym.LabEnv``. It needs the package ``gymnasium`` (``pip install labspec[gym]``).

Actions are the sliders of the lab, or the controls of its actuators. Observations are what the lab displays, or its state. The reward and the end
of an episode are expressions of the language of labs.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ._engine import Model
from ._lab import Control, Lab
from ._labspec import LabspecError
from ._recording import Value

#: What the texts that are added to a lab begin with.
_OWN = "labspec.gym"
#: Steps of the grid of an added slider: a number of `float32` is closer to one of them than to the next `float32`.
_GRID = 2**24


class LabEnv(gymnasium.Env[NDArray[np.float64], NDArray[np.float32]]):
    """A lab as an environment.

    ``actions`` is "ctrl", all actuators, or the labels of sliders. ``observations`` is "state" (positions, velocities, activations), or labels of traces and
    readouts. ``reward`` and ``terminated`` are expressions: ``"-Math.abs(data.qpos[1])"``, ``"data.qpos[1] > 0.5"``. An action holds for ``frame_skip``
    steps. An episode is truncated at ``until``, s, or where the lab stops.

    ``randomize`` are the sliders that each reset draws anew, evenly from their ranges; ``reset(options={"set": {"mass": 2}})`` sets controls. An observation
    or a reward that is no finite number ends the episode: its entry is 0, and ``info["not_finite"]`` names it.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        lab: Lab,
        *,
        reward: str,
        terminated: str | None = None,
        actions: str | Sequence[str] = "ctrl",
        observations: str | Sequence[str] = "state",
        frame_skip: int = 1,
        until: float | None = None,
        randomize: Sequence[str] = (),
        ctrl_range: tuple[float, float] = (-1.0, 1.0),
    ) -> None:
        if frame_skip < 1:
            raise ValueError("an action must hold for at least one step")
        texts = {"reward": reward, "terminated": terminated or "false"}
        added: list[dict[str, Any]] = []
        if actions == "ctrl":
            added = _sliders_of_actuators(lab.model, ctrl_range)
        elif isinstance(actions, str):
            raise ValueError('actions are "ctrl", or a list of labels of sliders')
        if observations == "state":
            texts |= _state(lab.model)
        elif isinstance(observations, str):
            raise ValueError('observations are "state", or a list of labels')
        self.lab = _with_texts(lab, added, texts)
        self._actions = [_slider(self.lab, label) for label in ([c["label"] for c in added[:-1]] if added else actions)]
        if not self._actions:
            raise ValueError("the lab has no actuator: name sliders as actions")
        self._random = [_slider(self.lab, label) for label in randomize]
        #: The places of the observations among the displayed values, and their names.
        self.observed = _places(self.lab, [f"{_OWN}/{n}" for n in texts if n not in ("reward", "terminated")] if observations == "state" else observations)
        self._reward, self._terminated = _places(self.lab, [f"{_OWN}/reward", f"{_OWN}/terminated"]).values()
        self._frame_skip, self._until = frame_skip, until
        self._switch = added[-1]["label"] if added else None
        self._start = self.lab.save()
        low, high = (np.array([getattr(a, end) for a in self._actions], np.float32) for end in ("min", "max"))
        self.action_space = gymnasium.spaces.Box(low, high, dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (len(self.observed),), np.float64)

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Starts an episode from the lab as it was opened."""
        super().reset(seed=seed)
        self.lab.restore(self._start)
        for slider in self._random:
            low, high, step = _range(slider)
            self.lab[slider.label] = _on_grid(slider, low + step * float(self.np_random.integers(0, round((high - low) / step) + 1)))
        chosen: Mapping[str, Value] = (options or {}).get("set", {})
        for label, value in chosen.items():
            self.lab[label] = value
        if self._switch is not None:
            self.lab.press(self._switch)
        observation, _reward, _terminated, info = self._now()
        return observation, info

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        """Sets the sliders or the actuators, and performs the steps of an action."""
        values = np.asarray(action, float).reshape(-1)
        if values.shape != (len(self._actions),) or not np.isfinite(values).all():
            raise ValueError(f"an action has {len(self._actions)} finite numbers")
        for slider, value in zip(self._actions, values.tolist(), strict=True):
            self.lab[slider.label] = _on_grid(slider, value)
        self.lab.step(self._frame_skip)
        observation, reward, terminated, info = self._now()
        truncated = self.lab.is_over or (self._until is not None and self.lab.time >= self._until - 1e-9)
        return observation, reward, terminated, truncated, info

    def _now(self) -> tuple[NDArray[np.float64], float, bool, dict[str, Any]]:
        values = self.lab._native.values()
        observed = [_number(values[place]) for place in self.observed.values()]
        reward = _number(values[self._reward])
        wrong = [name for name, x in zip(self.observed, observed, strict=True) if not math.isfinite(x)]
        wrong += ["reward"] * (not math.isfinite(reward))
        info: dict[str, Any] = {"time": self.lab.time} | ({"not_finite": wrong} if wrong else {})
        ended = values[self._terminated]
        observation = np.array([x if math.isfinite(x) else 0.0 for x in observed])
        return observation, reward if math.isfinite(reward) else 0.0, bool(ended) or bool(wrong), info


def _number(value: Value | None) -> float:
    return float(value) if isinstance(value, (int, float)) else math.nan


def _with_texts(lab: Lab, controls: list[dict[str, Any]], texts: Mapping[str, str]) -> Lab:
    """The lab with further controls and readouts."""
    source = lab.json
    readouts = [{"label": f"{_OWN}/{name}", "expr": text} for name, text in texts.items()]
    source["controls"] = [*(source.get("controls") or ()), *controls]
    source["readouts"] = [*(source.get("readouts") or ()), *readouts]
    made = Lab(json.loads(json.dumps(source)), lab._source[-1])
    wrong = [f for f in made.findings if f.severity == "error"]
    if wrong:
        error = LabspecError(f"an expression of the environment has an error: {wrong[0].message}")
        error.code, error.findings = wrong[0].code, [vars(f) for f in wrong]
        raise error
    return made


def _sliders_of_actuators(model: Model, otherwise: tuple[float, float]) -> list[dict[str, Any]]:
    """A slider for each actuator, and the button after which they act: until then the lab starts as its author wrote it."""
    controls: list[dict[str, Any]] = []
    for i in range(int(model.nu)):
        low, high = map(float, model.actuator_ctrlrange[i]) if model.actuator_ctrllimited[i] else otherwise
        apply = f"if (ctx.labspecGym) {{ data.ctrl[{i}] = value }}"
        middle = low + (high - low) / _GRID * round((min(max(0.0, low), high) - low) / (high - low) * _GRID)
        controls.append(
            {"label": f"{_OWN}/ctrl/{i}", "apply": apply, "min": low, "max": high, "step": (high - low) / _GRID, "value": middle}
        )
    return controls and [*controls, {"type": "button", "label": f"{_OWN}/act", "run": "ctx.labspecGym = true"}]


def _state(model: Model) -> dict[str, str]:
    sizes = {"qpos": int(model.nq), "qvel": int(model.nv), "act": int(model.na)}
    return {f"{name}[{i}]": f"data.{name}[{i}]" for name, size in sizes.items() for i in range(size)}


def _slider(lab: Lab, label: str) -> Control:
    found = next((c for c in lab.controls if c.label == label), None)
    if found is None or found.kind != "slider":
        raise KeyError(f'"{label}" is not a slider of the lab')
    return found


def _range(slider: Control) -> tuple[float, float, float]:
    low, high = float(slider.min or 0), float(slider.max or 0)
    return low, high, float(slider.step or (high - low) / 100)


def _on_grid(slider: Control, value: float) -> float:
    """The value of the slider that is nearest."""
    low, high, step = _range(slider)
    return min(high, low + step * round((min(max(value, low), high) - low) / step))


def _places(lab: Lab, labels: Sequence[str]) -> dict[str, int]:
    displayed = [d.label for d in lab.displayed]
    unknown = [label for label in labels if label not in displayed]
    if unknown:
        raise KeyError(f'nothing is displayed as "{unknown[0]}"')
    return {label.removeprefix(f"{_OWN}/"): displayed.index(label) for label in labels}
