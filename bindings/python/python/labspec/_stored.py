"""The runs of a sweep as Parquet files in a folder, from which a sweep that was killed continues."""

from __future__ import annotations

import hashlib
import json
import os
from importlib import import_module
from pathlib import Path
from typing import Any

from . import _labspec
from ._lab import Lab
from ._measure import Result
from ._recording import Value


class StoredSweep:
    """A folder with a file for each chunk of runs, and ``sweep.json``, which says what was run."""

    def __init__(self, folder: str, lab: Lab, runs: list[dict[str, Value]], measures: list[str], work: tuple[Any, ...]) -> None:
        """Opens the folder, or makes it.

        ``ValueError`` if it has another sweep: other runs, another lab, another model.
        """
        try:
            self._parquet: Any = import_module("pyarrow.parquet")
        except ImportError as e:
            raise ImportError("`out` needs the package pyarrow: pip install labspec[arrow]") from e
        self._arrow: Any = import_module("pyarrow")
        self._folder, self._measures = Path(folder), measures
        text = json.dumps([_labspec.__VERSION__, work[0], work[2], work[3], runs], sort_keys=False)
        digest = hashlib.sha256(text.encode() + lab.model.to_bytes()).hexdigest()
        described = {"labspec": _labspec.__VERSION__, "sweep": digest, "runs": len(runs), "measures": work[2]}
        self._folder.mkdir(parents=True, exist_ok=True)
        plan = self._folder / "sweep.json"
        if plan.exists():
            if _digest_in(plan) != digest:
                raise ValueError(f"{folder} contains a different sweep: name another folder, or delete this one")
        else:
            self._replace(plan, lambda path: path.write_text(json.dumps(described, indent=1), encoding="utf-8"))

    def read(self, index: int, runs: list[dict[str, Value]]) -> list[Result] | None:
        """The results of a chunk, if they were written completely."""
        path = self._path(index)
        if not path.exists():
            return None
        try:
            columns = self._parquet.read_table(path).to_pydict()
            errors = columns["error"]
            rows = zip(*(columns[f"measure/{name}"] for name in self._measures), strict=True) if self._measures else ((),) * len(errors)
            found = [([] if error is not None else list(row), error) for row, error in zip(rows, errors, strict=True)]
        except (KeyError, ValueError, OSError, self._arrow.ArrowException) as e:
            raise ValueError(f"{path} is not part of this sweep: {e}") from e
        if len(found) != len(runs):
            raise ValueError(f"{path} is not part of this sweep: it has {len(found)} runs, not {len(runs)}")
        return found

    def write(self, index: int, runs: list[dict[str, Value]], results: list[Result]) -> None:
        """Writes a chunk beside, and then puts it in its place."""
        labels = dict.fromkeys(label for run in runs for label in run)
        columns: dict[str, Any] = {label: _column([run.get(label) for run in runs]) for label in labels}
        for i, name in enumerate(self._measures):
            values = [float("nan") if error is not None else row[i] for row, error in results]
            columns[f"measure/{name}"] = self._arrow.array(values, self._arrow.float64())
        columns["error"] = self._arrow.array([error for _row, error in results], self._arrow.string())
        table = self._arrow.table(columns)
        self._replace(self._path(index), lambda path: self._parquet.write_table(table, path))

    def _path(self, index: int) -> Path:
        return self._folder / f"part-{index:06}.parquet"

    @staticmethod
    def _replace(path: Path, write: Any) -> None:
        beside = path.with_name(f".{path.name}.{os.getpid()}")
        write(beside)
        os.replace(beside, path)


def _column(values: list[Any]) -> list[Any]:
    """The values of a control, of one type."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float}:
        return [None if value is None else float(value) for value in values]
    return values if len(kinds) == 1 else [None if value is None else str(value) for value in values]


def _digest_in(plan: Path) -> str | None:
    try:
        found = json.loads(plan.read_text(encoding="utf-8"))
    except ValueError:
        return None
    return found.get("sweep") if isinstance(found, dict) else None
