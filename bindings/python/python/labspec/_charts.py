"""Charts of a sweep: tornado charts, maps and parallel coordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ._effects import Effect, Effects, Level
from ._recording import Value
from ._svg import AXIS_COLOUR, BLUE, GREY, GRID_COLOUR, NO_VALUE_COLOUR, RED, TITLE_COLOUR, Axis, Picture, Point, colour, fit, is_drawable, short, text_width

#: Lines of parallel coordinates; of more runs, every n-th is drawn.
_MOST_LINES = 2000
#: Values of a control on each side of a map.
_MOST_CELLS = 100
#: Parts of the scale of colours.
_PARTS = 24

#: For each pair of values of two controls the number, and why there is none.
Cells = Mapping[tuple[Value, Value], tuple[float, str | None]]


def tornado(effects: Effects) -> str:
    """A bar for each control, from the smallest to the largest mean of the measure; the largest bar is on top."""
    names = [fit(effect.control, 12, 200) for effect in effects.rows]
    left = 24 + max((text_width(name, 12) for name in names), default=0)
    width, top, row = 660.0, 76.0, 30
    picture = Picture(f"Effects on {effects.measure}", _of_tornado(effects), width, top + row * max(1, len(names)) + 44)
    picture.heading()
    if not effects.rows:
        picture.text((12, top), "no control has two values with a number")
        return picture.svg()
    bottom = top + row * len(names)
    # Texts beside the bars name the values of a control.
    axis = Axis([x for effect in effects.rows for x in (effect.low, effect.high, effects.centre) if is_drawable(x)], left + 105, width - 110)
    _grid(picture, axis, top, bottom, effects.measure)
    for i, (effect, name) in enumerate(zip(effects.rows, names, strict=True)):
        middle = top + row * (i + 0.5)
        picture.text((left - 6, middle + 4), name, anchor="end", colour=TITLE_COLOUR)
        _bar(picture, axis, effect, effects.centre, middle)
    centre = axis.place(effects.centre)
    if is_drawable(centre):
        picture.line([(centre, top - 6), (centre, bottom)], TITLE_COLOUR, dash="4 3")
        picture.text((centre, top - 10), ("mean " if effects.base is None else "base ") + short(effects.centre), size=11, anchor="middle")
    kinds = {effect.rises is None for effect in effects.rows}
    ordered, others = [("smaller value", BLUE), ("larger value", RED)] * (False in kinds), [("other value", GREY)] * (True in kinds)
    _legend(picture, ordered + others)
    return picture.svg()


def _bar(picture: Picture, axis: Axis, effect: Effect, centre: float, middle: float) -> None:
    """The two parts of a bar, with the values of the control at both ends."""
    a, b = axis.place(effect.low), axis.place(effect.high)
    at = min(b, max(a, axis.place(centre))) if is_drawable(centre) else (a + b) / 2
    colours = (GREY, GREY) if effect.rises is None else (BLUE, RED) if effect.rises else (RED, BLUE)
    for start, end, fill, value, level in ((a, at, colours[0], effect.low, effect.at_low), (at, b, colours[1], effect.high, effect.at_high)):
        picture.rectangle((start, middle - 9), (end - start, 18), fill, f"{effect.control} {_level(level)}: {short(value)}")
    for x, level, anchor in ((a - 5, effect.at_low, "end"), (b + 5, effect.at_high, "start")):
        picture.text((x, middle + 4), fit(_level(level), 11, 100), size=11, anchor=anchor)


def _of_tornado(effects: Effects) -> str:
    kind = "Means over the other controls." if effects.base is None else "One control differs from the base in each run."
    rows = (f"{e.control}: {short(e.low)} at {_level(e.at_low)}, {short(e.high)} at {_level(e.at_high)}." for e in effects.rows)
    return " ".join([f"A tornado chart of {effects.measure} over {effects.runs} runs. {kind}", *rows, *_without(effects.without)])


def _level(level: Level) -> str:
    return f"{short(level[0])} to {short(level[1])}" if isinstance(level, tuple) else short(level)


def _without(count: int) -> list[str]:
    return [f"Runs without a number: {count}."] * (count > 0)


def _grid(picture: Picture, axis: Axis, top: float, bottom: float, label: str) -> None:
    for x, name in axis.ticks():
        picture.line([(x, top), (x, bottom)], GRID_COLOUR)
        picture.text((x, bottom + 16), name, size=11, anchor="middle")
    picture.text(((axis.start + axis.end) / 2, bottom + 34), fit(label, 12, axis.end - axis.start), anchor="middle", colour=TITLE_COLOUR)


def _legend(picture: Picture, rows: Sequence[tuple[str, str]]) -> None:
    x = 12.0
    for name, fill in rows:
        picture.rectangle((x, 36), (10, 10), fill)
        picture.text((x + 15, 45), name, size=11)
        x += 30 + text_width(name, 11)


def cell_map(x: str, y: str, measure: str, cells: Cells) -> str:
    """The measure as a colour for each pair of values of two controls. A cell has its number, or why it has none."""
    columns, rows = (_ordered([pair[i] for pair in cells]) for i in (0, 1))
    if max(len(columns), len(rows)) > _MOST_CELLS:
        raise ValueError(f"a map has at most {_MOST_CELLS} values of a control")
    names = [fit(short(value), 11, 120) for value in rows]
    labels = [fit(short(value), 11, 90) for value in columns]
    left, top, right, bottom = 22 + max(text_width(name, 11) for name in names), 62.0, 520.0, 332.0
    picture = Picture(f"{measure} over {x} and {y}", _of_map(x, y, measure, cells), 640, 380)
    picture.heading()
    scale = Axis([value for value, _error in cells.values() if is_drawable(value)], bottom, top)
    width, height = (right - left) / len(columns), (bottom - top) / len(rows)
    for i, column in enumerate(columns):
        for j, row in enumerate(rows):
            value, error = cells.get((column, row), (math.nan, "not run"))
            text = short(value) if is_drawable(value) else error or "no number"
            place = left + i * width, bottom - (j + 1) * height
            _cell(picture, place, (width, height), scale, value, f"{x} {short(column)}, {y} {short(row)}: {text}")
    for j in range(0, len(rows), math.ceil(18 / height)):
        picture.text((left - 6, bottom - (j + 0.5) * height + 4), names[j], size=11, anchor="end")
    for i in range(0, len(columns), math.ceil((max(text_width(label, 11) for label in labels) + 8) / width)):
        picture.text((left + (i + 0.5) * width, bottom + 16), labels[i], size=11, anchor="middle")
    picture.text((12, 48), fit(y, 12, 480), colour=TITLE_COLOUR)
    picture.text(((left + right) / 2, bottom + 36), fit(x, 12, right - left), anchor="middle", colour=TITLE_COLOUR)
    _scale(picture, scale, measure)
    return picture.svg()


def _cell(picture: Picture, at: Point, size: Point, scale: Axis, value: float, name: str) -> None:
    """A cell, with its number if there is space for it."""
    known = is_drawable(value)
    share = (scale.place(value) - scale.start) / (scale.end - scale.start)
    picture.rectangle(at, size, colour(share) if known else NO_VALUE_COLOUR, name)
    text = short(value) if known else "×"
    if size[1] >= 14 and text_width(text, 11) + 6 <= size[0]:
        ink = "#ffffff" if known and share < 0.6 else "#000000"
        picture.text((at[0] + size[0] / 2, at[1] + size[1] / 2 + 4), text, size=11, anchor="middle", colour=ink)


def _scale(picture: Picture, scale: Axis, measure: str, x: float = 544) -> None:
    """The colours of numbers, beside a chart."""
    part = (scale.start - scale.end) / _PARTS
    for i in range(_PARTS):
        picture.rectangle((x, scale.start - (i + 1) * part), (14, part), colour((i + 0.5) / _PARTS))
    for y, name in scale.ticks():
        picture.text((x + 20, y + 4), name, size=11)
    picture.text((x, scale.end - 8), fit(measure, 12, 640 - x), colour=TITLE_COLOUR)


def _of_map(x: str, y: str, measure: str, cells: Cells) -> str:
    found = [(value, pair) for pair, (value, _error) in cells.items() if is_drawable(value)]
    text = [f"A map of {measure} over {x} and {y}, {len(cells)} cells."]
    for name, pick in (("Smallest", min), ("Largest", max)):
        if found:
            value, pair = pick(found, key=lambda row: row[0])
            text.append(f"{name}: {short(value)} at {x} {short(pair[0])}, {y} {short(pair[1])}.")
    return " ".join(text + _without(len(cells) - len(found)))


def _ordered(values: Sequence[Value]) -> list[Value]:
    """Different values: numbers by their size, others as they come."""
    every = list(dict.fromkeys(values))
    return every if any(isinstance(value, (str, bool)) for value in every) else sorted(every, key=float)


def parallel(columns: Mapping[str, Sequence[Value]], by: str) -> str:
    """A line for each run over the axes of controls and measures, in the colour of its number on the axis ``by``."""
    names = list(columns)
    width, top, bottom = max(640.0, 120.0 * len(names) + 100), 84.0, 320.0
    gap = (width - 190) / max(1, len(names) - 1)
    axes = [Axis([v for v in column if not isinstance(v, float) or is_drawable(v)], bottom, top) for column in columns.values()]
    rows = list(zip(*columns.values(), strict=True))
    drawn = [row for row in rows if all(math.isfinite(axis.place(value)) for axis, value in zip(axes, row, strict=True))]
    step = math.ceil(len(drawn) / _MOST_LINES) or 1
    picture = Picture(f"Runs by {by}", _of_parallel(columns, axes, len(rows), len(drawn), step), width, 360)
    picture.heading()
    coloured = axes[names.index(by)]
    for row in drawn[::step]:
        points = [(50 + i * gap, axis.place(value)) for i, (axis, value) in enumerate(zip(axes, row, strict=True))]
        share = (points[names.index(by)][1] - coloured.start) / (coloured.end - coloured.start)
        text = ", ".join(f"{name} {short(value)}" for name, value in zip(names, row, strict=True))
        picture.line(points, colour(0.9 * share), text, width=1.4, opacity=0.85 if len(drawn) <= 100 else 0.4)
    for i, (name, axis) in enumerate(zip(names, axes, strict=True)):
        x = 50 + i * gap
        picture.line([(x, top), (x, bottom)], AXIS_COLOUR)
        last = i == len(names) - 1
        picture.text((x, top - 14), fit(name, 12, gap if not last else 130), anchor="middle", colour=TITLE_COLOUR)
        ticks = axis.ticks()
        for y, tick in ticks[:: math.ceil(len(ticks) / 14)]:
            picture.line([(x - 3, y), (x + 3, y)], AXIS_COLOUR)
            picture.text((x + 6, y + 4), fit(tick, 11, gap - 12), size=11, halo=True)
    return picture.svg()


def _of_parallel(columns: Mapping[str, Sequence[Value]], axes: Sequence[Axis], runs: int, drawn: int, step: int) -> str:
    text = [f"Parallel coordinates of {runs} runs."]
    for name, axis in zip(columns, axes, strict=True):
        ends = f"{len(axis.names)} values" if axis.names is not None else f"from {short(axis.low)} to {short(axis.high)}"
        text.append(f"{name}: {ends}.")
    if step > 1:
        text.append(f"One of {step} runs is drawn.")
    return " ".join(text + _without(runs - drawn))
