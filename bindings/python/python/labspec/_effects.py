"""Effects of controls on a measure of a sweep: what a tornado chart draws."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ._recording import Value
from ._svg import is_drawable

#: With more values of a control, its runs are divided into groups.
_MOST_VALUES = 8
#: The number of these groups.
_GROUPS = 4

#: The value of a control, or the first and the last one of a group.
Level = Value | tuple[float, float]


@dataclass(frozen=True)
class Effect:
    """How a measure changes with one control."""

    control: str
    #: The smallest mean of the measure over the runs with equal values of the control, and the largest one.
    low: float
    high: float
    #: The values of the control with these means; a pair is the first and the last value of a group.
    at_low: Level
    at_high: Level

    @property
    def span(self) -> float:
        """The difference of both means."""
        return self.high - self.low

    @property
    def rises(self) -> bool | None:
        """Whether the measure is larger at the larger value; ``None`` for values that are no numbers."""
        ends = [level[0] if isinstance(level, tuple) else level for level in (self.at_low, self.at_high)]
        if any(isinstance(end, (bool, str)) for end in ends):
            return None
        return float(ends[0]) < float(ends[1])


@dataclass(frozen=True)
class Effects:
    """The effects of all controls that vary, the largest first."""

    measure: str
    rows: tuple[Effect, ...]
    #: The measure at the base, NaN if no run is there; without a base, the mean of all runs.
    centre: float
    #: The run from which each of the others differs in one control; ``None`` for means over all other controls.
    base: Mapping[str, Value] | None
    #: The number of runs, and of those without a number.
    runs: int
    without: int


def effects_of(measure: str, settings: Sequence[Mapping[str, Value]], values: Sequence[float], base: Mapping[str, Value] | None) -> Effects:
    """The effects of the controls on a measure.

    If each run differs from the base in one control at most, only these runs are compared. Without a base, that is the first run, if all others differ
    from it in this way; otherwise means are taken over the other controls.
    """
    pairs = [(run, value) for run, value in zip(settings, values, strict=True) if is_drawable(value)]
    without = len(values) - len(pairs)
    if base is not None and not any(len(_differences(run, base)) <= 1 for run in settings):
        raise ValueError("no run differs from the base in one control at most")
    if base is None and settings and all(len(_differences(run, settings[0])) <= 1 for run in settings):
        base = settings[0]
    rows = []
    for label in varied(settings):
        chosen = pairs if base is None else [(run, value) for run, value in pairs if _differences(run, base) <= {label}]
        effect = _effect(label, chosen)
        if effect is not None:
            rows.append(effect)
    centre = _mean([value for run, value in pairs if base is None or not _differences(run, base)])
    return Effects(measure, tuple(sorted(rows, key=lambda effect: -effect.span)), centre, base, len(values), without)


def varied(settings: Sequence[Mapping[str, Value]]) -> list[str]:
    """The controls with more than one value."""
    labels = dict.fromkeys(label for run in settings for label in run)
    return [label for label in labels if len({run[label] for run in settings if label in run}) > 1]


def _differences(run: Mapping[str, Value], base: Mapping[str, Value]) -> set[str]:
    return {label for label in run if label in base and run[label] != base[label]}


def _effect(label: str, pairs: Sequence[tuple[Mapping[str, Value], float]]) -> Effect | None:
    means = [(_mean(values), level) for level, values in _groups([(run[label], value) for run, value in pairs if label in run])]
    if len(means) < 2:
        return None
    low, high = min(means, key=lambda row: row[0]), max(means, key=lambda row: row[0])
    return Effect(label, low[0], high[0], low[1], high[1])


def _groups(rows: Sequence[tuple[Value, float]]) -> list[tuple[Level, list[float]]]:
    """The measure for each value of a control; for many numbers, in four groups of about equally many values."""
    found: dict[Value, list[float]] = {}
    for level, value in rows:
        found.setdefault(level, []).append(value)
    numbers = sorted(level for level in found if isinstance(level, (int, float)) and not isinstance(level, bool))
    if len(found) <= _MOST_VALUES or len(numbers) < len(found):
        return list(found.items())
    cuts = [i * len(numbers) // _GROUPS for i in range(_GROUPS + 1)]
    parts = [numbers[a:b] for a, b in zip(cuts, cuts[1:], strict=False)]
    return [((float(part[0]), float(part[-1])), [value for level in part for value in found[level]]) for part in parts]


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values) if values else math.nan
