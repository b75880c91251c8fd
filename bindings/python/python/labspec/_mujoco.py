"""A lab on MuJoCo itself: the package ``mujoco`` steps, the programs and measures of the lab are those of labspec (``pip install labspec[mujoco]``).

The order of events is that of a page. What programs and measures read of ``data`` and ``model`` is what MuJoCo computed; functions of the language
that compute something themselves (``lib.jacobian``, ``lib.normalForce``) use the engine of labspec at the state of MuJoCo.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from . import _aggregates
from ._fields import writable_names
from ._files import files_of
from ._lab import Lab
from ._labspec import Evaluator, LabspecError
from ._recording import Value

#: Warnings of MuJoCo after which it resets the data, and the numbers that are bad.
_BAD = {"mjWARN_BADQPOS": "qpos", "mjWARN_BADQVEL": "qvel", "mjWARN_BADQACC": "qacc"}


def the_package() -> Any:
    """The package ``mujoco``."""
    try:
        return import_module("mujoco")
    except ImportError as e:
        raise ImportError("this needs the package mujoco: pip install labspec[mujoco]") from e


class MujocoLab:
    """A lab that is open on MuJoCo. ``lab["mass"] = 2`` moves a slider."""

    def __init__(self, lab: Lab) -> None:
        """Opens a lab as it was opened in labspec: steps 1 to 3 of the order of events.

        ``LabspecError`` if it has errors, or if MuJoCo refuses its model.
        """
        self._mujoco = the_package()
        self._programs = Evaluator(lab._labelled(), lab._source[-1])
        try:
            self.model = _model(self._mujoco, lab)
        except ValueError as e:
            raise _error("model", f"MuJoCo refuses the model of the lab: {e}") from e
        self.data = self._mujoco.MjData(self.model)
        self._controls = self._programs.controls()
        self._labels = [label for label, *_more in self._controls]
        self._values = [start for _label, start, *_more in self._controls]
        self._measures: dict[str, _Measure] = {}
        self._state = [name for name in writable_names("data") if _of(self.data, name) is not None]
        #: What was read, but MuJoCo does not have under this name.
        self.missing: tuple[str, ...] = ()
        #: Warnings before the last reset, and whether a step met a bad number.
        self.broke: str | None = None
        self._warned = 0
        self._look()
        self._load()

    @property
    def engine(self) -> str:
        """The engine and its version."""
        return f"MuJoCo {self._mujoco.__version__}"

    def _load(self) -> None:
        self._forward()
        if self._programs.key is not None:
            self._reset_data()
        for i, (_label, start, _init, _reset) in enumerate(self._controls):
            if start is not None:
                self._change(partial(self._programs.apply, i, start))
        self._after_reset()

    def __getitem__(self, label: str) -> Value:
        value = self._values[self._index(label)]
        if value is None:
            raise _error("call", f'"{label}" is a button: it has no value')
        return value

    def __setitem__(self, label: str, value: Value) -> None:
        i = self._index(label)
        _label, start, _init, resets = self._controls[i]
        if start is None:
            raise _error("call", f'"{label}" is a button: press it instead of setting it')
        self._values[i] = value
        self._change(partial(self._programs.apply, i, value))
        if resets:
            self.reset()
        else:
            self._forward()

    def press(self, label: str) -> None:
        """Presses a button."""
        i = self._index(label)
        if self._controls[i][1] is not None:
            raise _error("call", f'"{label}" is not a button: set it instead of pressing it')
        self._change(partial(self._programs.press, i))
        self._forward()

    def reset(self) -> None:
        """Resets like the button of the page: controls and model keep their values."""
        self._reset_data()
        self._after_reset()

    def step(self) -> None:
        """Runs the controller, and performs a step of MuJoCo."""
        before = self.data.time
        self._change(self._programs.controller)
        self._pull_state()
        self._programs.follow()
        self._mujoco.mj_step(self.model, self.data)
        self._note(before)

    def run_statements(self, text: str) -> None:
        """Runs statements, and computes all fields: the ``setup`` of a run."""
        compiled = self._programs.compile(text, True)
        self._look()
        self._change(partial(self._programs.execute, compiled["index"]))
        self._forward()

    @property
    def time(self) -> float:
        """The simulated time, s."""
        return float(self.data.time)

    @property
    def warnings(self) -> int:
        """How often MuJoCo met a bad number, and warned otherwise."""
        return self._warned + self._current_warnings()

    def measure(
        self,
        measures: Mapping[str, str],
        *,
        steps: int,
        press: Iterable[tuple[str, float]] = (),
        stop: str | None = None,
        stop_at: float | None = None,
        perturbation: float = 0.0,
    ) -> dict[str, float]:
        """Performs steps, and measures them. Buttons are pressed at their times, s; the run ends where the condition ``stop`` holds.

        With ``stop_at``, s, it ends when its time reaches that, whatever the number of steps: a program may reset it.
        """
        running = {name: _Measure(self._programs, text) for name, text in measures.items()}
        ends = None if stop is None else _Measure(self._programs, stop)
        self._look()
        if perturbation:
            self.data.qpos[:] += perturbation
            self._forward()
        pending = sorted(press, key=lambda one: one[1])
        # Warnings are counted. MuJoCo would print them, too, and write a file into the current folder.
        before = self._mujoco.get_mju_user_warning()
        self._mujoco.set_mju_user_warning(lambda _text: None)
        try:
            self._play(running.values(), ends, steps, pending, stop_at)
        finally:
            self._mujoco.set_mju_user_warning(before)
        return {name: one.now() for name, one in running.items()}

    def _play(
        self, running: Iterable[_Measure], ends: _Measure | None, steps: int, pending: list[tuple[str, float]], stop_at: float | None
    ) -> None:
        # As in labspec, a run that something resets again and again ends after 20 times its steps, and one that has diverged after its steps.
        most = steps if stop_at is None else 20 * steps
        for made in range(most + 1):
            while pending and self.time >= pending[0][1] - 1e-12:
                self.press(pending.pop(0)[0])
            if made > 0:
                try:
                    self.step()
                except LabspecError as e:
                    self.broke = self.broke or f"the controller failed: {e}"
                    return
            self._pull()
            self._programs.probes()
            for one in running:
                one.sample(self.time)
            if ends is not None and ends.now() == 1:
                return
            if self.broke is not None and made >= steps:
                return
            if stop_at is not None and self.time >= stop_at - 1e-9 * float(self.model.opt.timestep) - made * 2.3e-16 * abs(stop_at):
                return

    def compiles(self, text: str) -> None:
        """Refuses a measure that has errors, or an aggregate that is not evaluated here."""
        _Measure(self._programs, text)

    def values(self) -> list[Value | None]:
        """The traces, then the readouts."""
        self._pull()
        return self._programs.probes()

    # Copies between the engines.

    def _look(self) -> None:
        """Looks again at what programs and measures read and write."""
        reads, writes = self._programs.reads(), self._programs.writes()
        self._reads = [name for name in reads if _of(self._owner(name), name) is not None and name.removeprefix("data.") not in self._state]
        self.missing = tuple(name for name in reads if _of(self._owner(name), name) is None)
        self._writes = [name for name in writes if _of(self._owner(name), name) is not None]

    def _owner(self, name: str) -> Any:
        return self.data if name.startswith("data.") else self.model

    def _pull_state(self) -> None:
        for name in self._state:
            self._programs.copy(f"data.{name}", np.ravel(_of(self.data, name)).astype(float))

    def _pull(self) -> None:
        """Copies the state, and all that is read."""
        self._pull_state()
        for name in self._reads:
            self._programs.copy(name, np.ravel(_of(self._owner(name), name)).astype(float))
        contact = self.data.contact
        self._programs.copy_contacts(np.column_stack([contact.geom1, contact.geom2]).tolist() if self.data.ncon else [])

    def _change(self, program: Callable[[], object]) -> None:
        """Runs a program, and copies what it may have written. Functions that compute fields may write every field of the state, and the constants of the
        model are computed by MuJoCo."""
        self._pull()
        self._programs.take_passes()
        program()
        self._push(self._writes)
        passes = self._programs.take_passes()
        if "mj_setConst" in passes:
            self._mujoco.mj_setConst(self.model, self.data)
        if passes:
            self._push([*(f"data.{name}" for name in self._state), *self._writes])

    def _push(self, names: Iterable[str]) -> None:
        """Copies fields to MuJoCo."""
        for name in names:
            owner = self._owner(name)
            *parents, last = name.split(".")[1:]
            for parent in parents:
                owner = getattr(owner, parent)
            values, now = self._programs.field(name), getattr(owner, last)
            if not isinstance(now, np.ndarray):
                setattr(owner, last, type(now)(values[0]))
            elif now.size == values.size:
                now[...] = values.reshape(now.shape)

    def _forward(self) -> None:
        self._mujoco.mj_forward(self.model, self.data)
        self._pull_state()
        self._programs.forward()

    def _reset_data(self) -> None:
        self._warned += self._current_warnings()
        key = self._programs.key
        if key is not None and key < self.model.nkey:
            self._mujoco.mj_resetDataKeyframe(self.model, self.data, key)
        else:
            self._mujoco.mj_resetData(self.model, self.data)
        self._forward()

    def _after_reset(self) -> None:
        self._change(self._programs.setup)
        for i, (_label, _start, init, _reset) in enumerate(self._controls):
            value = self._values[i]
            if init and value is not None:
                self._change(partial(self._programs.apply, i, value, False))
        self._forward()

    def _current_warnings(self) -> int:
        return int(sum(one.number for one in self.data.warning))

    def _note(self, before: float) -> None:
        """Notes a step after which MuJoCo has reset the data. The warnings of such a step are still there, those before it are not."""
        if self.data.time < before and self.broke is None:
            kinds = {name: getattr(self._mujoco.mjtWarning, key, None) for key, name in _BAD.items()}
            bad = [name for name, kind in kinds.items() if kind is not None and self.data.warning[int(kind)].number]
            self.broke = f"a bad number in {', '.join(bad) or 'the state'} at t = {before:g} s"

    def _index(self, label: str) -> int:
        if label not in self._labels:
            raise KeyError(f'the lab has no control "{label}"')
        return self._labels.index(label)


class _Measure:
    """A measure during a run: a program, and what becomes of its parts over all samples."""

    def __init__(self, programs: Evaluator, text: str) -> None:
        self._programs = programs
        self._root = _node(programs.compile(text))

    def sample(self, time: float) -> None:
        """Takes the current sample."""
        self._sample(self._root, time)

    def now(self) -> float:
        """The value up to the last sample."""
        return self._value(self._root)

    def _sample(self, node: _Node, time: float) -> None:
        for part in node.parts:
            for argument in part.arguments:
                self._sample(argument, time)
            part.running.sample(partial(self._argument, part), time)

    def _argument(self, part: _Part, index: int) -> float:
        return self._value(part.arguments[index])

    def _value(self, node: _Node) -> float:
        for part in node.parts:
            self._programs.set_aggregate(part.slot, _aggregates.result_of(part.running))
        value = self._programs.value(node.index)
        return float(value) if isinstance(value, (bool, int, float)) else np.nan


class _Part:
    """A call of an aggregate."""

    def __init__(self, name: str, slot: int, arguments: list[dict[str, Any]]) -> None:
        self.slot, self.arguments = slot, [_node(argument) for argument in arguments]
        self.running = _aggregates.running(name, len(arguments))


class _Node:
    """A compiled text."""

    def __init__(self, index: int, parts: list[_Part]) -> None:
        self.index, self.parts = index, parts


def _node(compiled: dict[str, Any]) -> _Node:
    return _Node(compiled["index"], [_Part(*one) for one in compiled["aggregates"]])


def _of(owner: Any, name: str) -> Any:
    """A field, by its name with or without the object: numbers, or ``None``."""
    for part in name.removeprefix("data.").removeprefix("model.").split("."):
        owner = getattr(owner, part, None)
    return owner if isinstance(owner, (int, float, np.ndarray)) and np.asarray(owner).dtype.kind in "biuf" else None


def _model(mujoco: Any, lab: Lab) -> Any:
    """The model of a lab, compiled by MuJoCo."""
    source, models = lab.json, lab._source[-1]
    xml = source.get("xml")
    if isinstance(models, Mapping):
        texts = {(name if name.endswith(".xml") else f"{name}.xml"): text.encode() for name, text in models.items()}
        return mujoco.MjModel.from_xml_string(models[source["model"]] if xml is None else xml, texts)
    if xml is not None:
        return mujoco.MjModel.from_xml_string(xml, {} if models is None else files_of(xml, Path(models)))
    # The lab is open: the name is that of a model in this folder.
    return mujoco.MjModel.from_xml_path(os.fspath(Path(models) / f"{source['model']}.xml"))


def _error(code: str, message: str) -> LabspecError:
    error = LabspecError(message)
    error.code, error.findings = code, []
    return error
