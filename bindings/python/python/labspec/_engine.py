"""Models and data with fields as attributes, and objects by their names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from operator import index
from typing import Any

import numpy as np

from . import _labspec
from ._fields import KINDS, names_of, of_kind

Files = Mapping[str, str] | str | os.PathLike[str] | None


class _Object:
    """An object of a model, or its part of the data: ``data.body("cube").xpos``."""

    __slots__ = ("_fields", "_kind", "_model", "_owner", "id")

    def __init__(self, owner: Model | Data, model: Model, kind: str, key: str | int) -> None:
        word, size = KINDS[kind]
        if isinstance(key, str):
            at = model._native.id(word, key)
        else:
            at, count = index(key), model._native.field(size)
            if not 0 <= at < count:
                raise IndexError(f"the model has {count} objects of the kind {kind}, counted from 0")
        put = object.__setattr__
        put(self, "_fields", of_kind("data" if owner is not model else "model", kind))
        put(self, "_kind", kind)
        put(self, "_model", model)
        put(self, "_owner", owner)
        put(self, "id", at)

    @property
    def name(self) -> str:
        """The name of the object."""
        found: str = self._model._native.names(KINDS[self._kind][0])[self.id]
        return found

    def _rows(self, attribute: str) -> tuple[str, int | slice]:
        found = self._fields.get(attribute)
        if found is None:
            raise AttributeError(f"a {self._kind} has no field `{attribute}`; it has {', '.join(sorted(self._fields))}")
        field, size = found
        if size == KINDS[self._kind][1]:
            return field, self.id
        return field, self._slice(size)

    def _slice(self, size: str) -> slice:
        model = self._model
        if size == "nsensordata":
            start = int(model.sensor_adr[self.id])
            return slice(start, start + int(model.sensor_dim[self.id]))
        address, per_type = ("jnt_qposadr", (7, 4, 1, 1)) if size == "nq" else ("jnt_dofadr", (6, 3, 1, 1))
        start = int(getattr(model, address)[self.id])
        return slice(start, start + per_type[int(model.jnt_type[self.id])])

    def __getattr__(self, attribute: str) -> Any:
        field, rows = self._rows(attribute)
        return getattr(self._owner, field)[rows]

    def __setattr__(self, attribute: str, value: Any) -> None:
        field, rows = self._rows(attribute)
        getattr(self._owner, field)[rows] = value

    def __dir__(self) -> list[str]:
        return ["id", "name", *self._fields]

    def __repr__(self) -> str:
        return f'<{self._kind} "{self.name}", id {self.id}>'


class _Named:
    """Objects by name or id, for models and data."""

    __slots__ = ()

    def _object(self, kind: str, key: str | int) -> Any:
        raise NotImplementedError

    def body(self, key: str | int) -> Any:
        """A body."""
        return self._object("body", key)

    def joint(self, key: str | int) -> Any:
        """A joint, with its part of ``qpos`` and ``qvel``."""
        return self._object("joint", key)

    def geom(self, key: str | int) -> Any:
        """A geom."""
        return self._object("geom", key)

    def site(self, key: str | int) -> Any:
        """A site."""
        return self._object("site", key)

    def camera(self, key: str | int) -> Any:
        """A camera."""
        return self._object("camera", key)

    def light(self, key: str | int) -> Any:
        """A light."""
        return self._object("light", key)

    def actuator(self, key: str | int) -> Any:
        """An actuator."""
        return self._object("actuator", key)

    def tendon(self, key: str | int) -> Any:
        """A tendon."""
        return self._object("tendon", key)

    def equality(self, key: str | int) -> Any:
        """An equality."""
        return self._object("equality", key)

    def sensor(self, key: str | int) -> Any:
        """A sensor; ``data`` is its part of ``sensordata``."""
        return self._object("sensor", key)

    def key(self, key: str | int) -> Any:
        """A keyframe."""
        return self._object("key", key)


class _Part:
    """``model.opt`` and ``model.stat``."""

    __slots__ = ("_native", "_part")

    def __init__(self, native: _labspec.Model, part: str) -> None:
        object.__setattr__(self, "_native", native)
        object.__setattr__(self, "_part", part)

    def __getattr__(self, name: str) -> Any:
        return self._native.field(f"{self._part}.{name}")

    def __setattr__(self, name: str, value: Any) -> None:
        self._native.set_field(f"{self._part}.{name}", value)

    def __dir__(self) -> list[str]:
        return list(names_of(f"model.{self._part}"))


class Model(_Named):
    """A compiled model. Fields with rows are NumPy arrays that show its memory; single numbers are numbers."""

    __slots__ = ("_native",)
    _native: _labspec.Model

    def __init__(self, native: _labspec.Model) -> None:
        if not isinstance(native, _labspec.Model):
            raise TypeError("make a model with Model.from_xml, Model.from_file or Model.from_bytes")
        object.__setattr__(self, "_native", native)

    @classmethod
    def from_xml(cls, xml: str, files: Files = None) -> Model:
        """Compiles a model from MJCF. ``files`` are the files that it refers to: a folder, or texts by name."""
        return cls(_labspec.Model.from_xml(xml, files))

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Model:
        """Compiles a model from a file, which may refer to files in the same folder and below."""
        return cls(_labspec.Model.from_file(path))

    @classmethod
    def from_bytes(cls, content: bytes) -> Model:
        """Creates a model from the bytes of :meth:`to_bytes`, made by the same version."""
        return cls(_labspec.Model.from_bytes(content))

    def to_bytes(self) -> bytes:
        """The model as bytes."""
        return self._native.to_bytes()

    @property
    def name(self) -> str:
        """The name of the model."""
        return self._native.name

    @property
    def opt(self) -> Any:
        """The options: ``model.opt.timestep``."""
        return _Part(self._native, "opt")

    @property
    def stat(self) -> Any:
        """The statistics: ``model.stat.extent``."""
        return _Part(self._native, "stat")

    def _object(self, kind: str, key: str | int) -> Any:
        return _Object(self, self, kind, key)

    def __getattr__(self, name: str) -> Any:
        return self._native.field(name)

    def __setattr__(self, name: str, value: Any) -> None:
        self._native.set_field(name, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *names_of("model")]

    def __reduce__(self) -> Any:
        return Model.from_bytes, (self.to_bytes(),)

    def __repr__(self) -> str:
        return repr(self._native)


class Data(_Named):
    """A simulation of a model: its state and results. Fields with rows are NumPy arrays that show its memory."""

    # Arrays that were taken once are attributes: the memory that they show stays where it is.
    __slots__ = ("__dict__", "_model", "_native")
    _model: Model
    _native: _labspec.Data

    def __init__(self, model: Model) -> None:
        object.__setattr__(self, "_model", model)
        object.__setattr__(self, "_native", _labspec.Data(model._native))

    @property
    def model(self) -> Model:
        """The model."""
        return self._model

    def step(self, steps: int = 1) -> None:
        """Performs steps. Other threads of Python run meanwhile, and Ctrl-C ends them after a step."""
        self._native.step(steps)

    def forward(self) -> None:
        """Computes all fields from the state and the inputs."""
        self._native.call("forward")

    def inverse(self) -> None:
        """Computes the forces that result in ``qacc``, to ``qfrc_inverse``."""
        self._native.call("inverse")

    def reset(self, key: int | str | None = None) -> None:
        """Resets to the default configuration, or to a keyframe."""
        self._native.reset(self._model._native.id("key", key) if isinstance(key, str) else key)

    def set_const(self) -> None:
        """Computes the constants of the model that depend on masses, inertias and poses, and resets the data."""
        self._native.set_const()

    def save(self) -> bytes:
        """The complete simulation as bytes."""
        return self._native.save()

    def restore(self, content: bytes) -> None:
        """Restores the bytes of :meth:`save` of the same model. It continues with equal results, bit for bit.

        The data get other memory: arrays that were taken before keep showing the data before.
        """
        self._native.restore(content)
        self.__dict__.clear()

    def _object(self, kind: str, key: str | int) -> Any:
        return _Object(self, self._model, kind, key)

    def __getattr__(self, name: str) -> Any:
        found = self._native.field(name)
        if isinstance(found, np.ndarray) and isinstance(found.base, memoryview) and isinstance(found.base.obj, _labspec.FieldView):
            self.__dict__[name] = found
        return found

    def __setattr__(self, name: str, value: Any) -> None:
        self._native.set_field(name, np.asarray(value, float))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *names_of("data")]

    def __reduce__(self) -> Any:
        return _restored, (self._model, self.save())

    def __repr__(self) -> str:
        return repr(self._native)


def _restored(model: Model, content: bytes) -> Data:
    data = Data(model)
    data.restore(content)
    return data
