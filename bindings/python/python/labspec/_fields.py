"""Which fields an object of a kind has, from the table of fields."""

from __future__ import annotations

from functools import cache
from typing import Final

from ._labspec import field_docs

#: The kinds of objects: how functions name them, their word in the engine, and the size that counts them.
KINDS: Final = {
    "body": ("body", "nbody"),
    "joint": ("jnt", "njnt"),
    "geom": ("geom", "ngeom"),
    "site": ("site", "nsite"),
    "camera": ("cam", "ncam"),
    "light": ("light", "nlight"),
    "actuator": ("actuator", "nu"),
    "tendon": ("tendon", "ntendon"),
    "equality": ("eq", "neq"),
    "sensor": ("sensor", "nsensor"),
    "key": ("key", "nkey"),
}


@cache
def of_kind(owner: str, kind: str) -> dict[str, tuple[str, str]]:
    """The fields that objects of a kind have in the model or the data: by attribute, the field and the size of its rows."""
    prefix, size = KINDS[kind]
    found: dict[str, tuple[str, str]] = {}
    for table, name, _unit, _doc, shape, _writable in field_docs():
        if table != owner or not shape:
            continue
        if shape[0] == size:
            found[name.removeprefix(f"{prefix}_")] = (name, size)
        elif kind == "joint" and shape[0] in ("nq", "nv"):
            found.setdefault(name.removeprefix("dof_"), (name, shape[0]))
        elif kind == "sensor" and name == "sensordata":
            found["data"] = (name, "nsensordata")
    return found


@cache
def names_of(owner: str) -> tuple[str, ...]:
    """The names of the fields of the model or the data."""
    return tuple(name for table, name, *_ in field_docs() if table == owner)


@cache
def writable_names(owner: str) -> tuple[str, ...]:
    """The names of the fields of the model or the data that a caller may write: state, inputs and parameters."""
    return tuple(name for table, name, _unit, _doc, _shape, writable in field_docs() if table == owner and writable)
