"""Charts of sweeps: every number that they draw is computed again here, from the runs and from the scale of the axis."""

import itertools
import math
import statistics
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from test_html import EVIL, tags
from test_sweep import LAB

import labspec

GRID = {"gravity": [-2, -5, -10, -20], "height": [0.5, 1, 2]}
MEASURES = {"lands": "first(contact('ball', 'floor'))", "low": "min(data.qpos[2])"}
BLUE, RED, GREY = "#0072b2", "#d55e00", "#8c8c8c"


def made(params, lands, starts=None):
    """A sweep with given numbers."""
    errors = tuple("it broke" if math.isnan(x) else None for x in lands)
    return labspec.Sweep(tuple(params), {"lands": np.array(lands, float)}, errors, starts or {})


def number(text):
    return float(text.replace("\N{MINUS SIGN}", "-"))


class Drawn:
    """What a picture contains."""

    def __init__(self, svg):
        self.svg, self.root = svg, ElementTree.fromstring(svg)
        kind = lambda name: [e for e in self.root.iter() if e.tag.endswith(f"}}{name}")]
        self.texts = [(float(e.get("x")), float(e.get("y")), e.text or "") for e in kind("text")]
        self.rectangles = [e for e in kind("rect") if len(e)]
        self.lines = [e for e in kind("polyline") if len(e)]
        self.title, self.description = (next(e.text for e in self.root if e.tag.endswith(f"}}{name}")) for name in ("title", "desc"))
        assert self.root.get("role") == "img" and self.title and self.description
        assert not any("href" in name or name.startswith(("on", "id")) for e in self.root.iter() for name in e.attrib), "nothing is loaded, run or named"

    def scale(self, at, along=0):
        """The function from pixels to numbers along an axis, by two labels of its ticks at pixel ``at`` of the other one."""
        ticks = [(row[along] - (4 if along else 0), number(row[2])) for row in self.texts if abs(row[1 - along] - at) < 0.01]
        assert len(ticks) >= 2, self.texts
        (a, x), (b, y) = ticks[0], ticks[-1]
        assert all(abs(x + (p - a) * (y - x) / (b - a) - n) < 0.02 * abs(y - x) for p, n in ticks), "ticks are linear"
        return lambda pixel: x + (pixel - a) * (y - x) / (b - a)

    def bars(self):
        """The two parts of each bar: control, colour, left and right number."""
        bottom = max(y for _x, y, _text in self.texts) - 18
        scale = self.scale(bottom)
        rows = {}
        for e in self.rectangles:
            x, width = float(e.get("x")), float(e.get("width"))
            rows.setdefault(float(e.get("y")), []).append((e[0].text, e.get("fill"), scale(x), scale(x + width)))
        return [rows[y] for y in sorted(rows)]


@pytest.fixture(scope="module")
def swept():
    return labspec.sweep(labspec.Lab(LAB), GRID, MEASURES)


def means(found, label):
    levels = dict.fromkeys(run[label] for run in found.params)
    return {level: statistics.fmean(x for run, x in zip(found.params, found["lands"], strict=True) if run[label] == level) for level in levels}


def test_a_tornado_draws_the_means_of_the_runs(swept):
    drawn = Drawn(swept.tornado())
    effects = swept.effects()
    spans = {label: means(swept, label) for label in GRID}
    order = sorted(GRID, key=lambda label: min(spans[label].values()) - max(spans[label].values()))
    assert [effect.control for effect in effects.rows] == order and effects.base is None
    centre = statistics.fmean(swept["lands"])
    for effect, bar in zip(effects.rows, drawn.bars(), strict=True):
        levels = spans[effect.control]
        low, high = min(levels, key=levels.get), max(levels, key=levels.get)
        assert (effect.at_low, effect.at_high, effect.rises) == (low, high, low < high)
        assert (effect.low, effect.high) == pytest.approx((levels[low], levels[high]), rel=1e-12)
        (left, left_fill, a, at), (right, right_fill, again, b) = bar
        assert (a, at, again, b) == pytest.approx((levels[low], centre, centre, levels[high]), abs=2e-4)
        assert (left_fill, right_fill) == (BLUE, RED), "a smaller value falls longer"
        assert left.startswith(effect.control) and number(left.rpartition(" ")[2]) == pytest.approx(levels[low], rel=1e-3)
        assert number(right.rpartition(" ")[2]) == pytest.approx(levels[high], rel=1e-3)
        for text in (effect.control, f"{high}", f"{low}".replace("-", "\N{MINUS SIGN}")):
            assert text.replace("-", "\N{MINUS SIGN}") in [row[2] for row in drawn.texts]
        assert f"{effect.control}: " in drawn.description
    assert "over 12 runs" in drawn.description and "mean" in " ".join(row[2] for row in drawn.texts)


def test_a_falling_measure_has_the_larger_value_on_the_left():
    found = made([{"a": a} for a in (1, 2, 3)], [5, 4, 1])
    [effect] = found.effects().rows
    assert (effect.low, effect.high, effect.at_low, effect.at_high, effect.rises) == (1, 5, 3, 1, False)
    [bar] = Drawn(found.tornado()).bars()
    assert [part[1] for part in bar] == [RED, BLUE]
    texts = made([{"a": a} for a in ("x", "y")], [5, 4])
    assert texts.effects().rows[0].rises is None
    assert [part[1] for part in Drawn(texts.tornado()).bars()[0]] == [GREY, GREY]


def test_single_changes_are_compared_with_their_base():
    starts = {"gravity": -9.8, "height": 1, "kind": "a"}
    runs = [{}, {"gravity": -2}, {"gravity": -20}, {"height": 2}, {"kind": "b"}]
    found = made(runs, [1.0, 3.0, 0.5, 1.25, 1.125], starts)
    effects = found.effects()
    assert effects.base == starts and effects.centre == 1.0
    assert [(e.control, e.low, e.high, e.at_low, e.at_high) for e in effects.rows] == [
        ("gravity", 0.5, 3.0, -20, -2),
        ("height", 1.0, 1.25, 1, 2),
        ("kind", 1.0, 1.125, "a", "b"),
    ]
    drawn = Drawn(found.tornado())
    assert [bar[0][3] for bar in drawn.bars()] == pytest.approx([1.0] * 3, abs=5e-3) and "base 1" in [row[2] for row in drawn.texts]
    grid = made([{"a": a, "b": b} for a, b in itertools.product((0, 1, 2), (0, 1))], [0, 10, 1, 20, 2, 40])
    at = grid.effects(base={"a": 1, "b": 0})
    assert [(e.control, e.low, e.high) for e in at.rows] == [("b", 1, 20), ("a", 0, 2)] and at.centre == 1
    assert [e.high for e in grid.effects().rows] == [70 / 3, 21]
    assert math.isnan(grid.effects(base={"a": 1, "b": 7}).centre) and Drawn(grid.tornado(base={"a": 1, "b": 7}))
    for base, error in (({"a": 9, "b": 9}, ValueError), ({"c": 1}, KeyError)):
        with pytest.raises(error):
            grid.effects(base=base)


def test_many_values_are_compared_in_four_groups():
    values = [(7 * i) % 101 for i in range(101)]
    found = made([{"a": x, "b": x % 2} for x in values], [3.0 * x for x in values])
    effect = next(e for e in found.effects().rows if e.control == "a")
    assert effect.at_low == (0, 24) and effect.at_high == (75, 100)
    assert (effect.low, effect.high) == pytest.approx((3 * 12, 3 * 87.5))
    assert "0 to 24" in [row[2] for row in Drawn(found.tornado()).texts]


def test_a_map_draws_every_run(swept):
    drawn = Drawn(swept.map("gravity", "height", "lands"))
    assert len(drawn.rectangles) == 12
    lands = {(run["gravity"], run["height"]): x for run, x in zip(swept.params, swept["lands"], strict=True)}
    columns, rows = sorted(GRID["gravity"]), sorted(GRID["height"])
    xs, ys = (sorted({float(e.get(key)) for e in drawn.rectangles}) for key in ("x", "y"))
    fills = {}
    for e in drawn.rectangles:
        pair = columns[xs.index(float(e.get("x")))], rows[len(rows) - 1 - ys.index(float(e.get("y")))]
        assert e[0].text == f"gravity \N{MINUS SIGN}{-pair[0]}, height {pair[1]:g}: {float(f'{lands[pair]:.4g}'):g}"
        fills[pair] = e.get("fill")
    order = sorted(lands, key=lands.get)
    assert (fills[order[0]], fills[order[-1]]) == ("#440154", "#fde725"), "the smallest and the largest number have the ends of the scale"
    assert len(set(fills.values())) == len(set(lands.values()))
    assert f"Smallest: {lands[order[0]]:.4g} at gravity \N{MINUS SIGN}20, height 0.5" in drawn.description
    written = [row[2] for row in drawn.texts]
    assert all(f"{float(f'{x:.4g}'):g}" in written for x in lands.values())
    # The scale of colours has the ticks of the numbers.
    scale = drawn.scale(564, along=1)
    assert (scale(332), scale(62)) == pytest.approx((min(lands.values()), max(lands.values())), abs=5e-3)


def test_a_map_of_more_controls_needs_the_others():
    runs = [{"a": a, "b": b, "c": c} for a, b, c in itertools.product((1, 2), (1, 2), ("x", "y"))]
    found = made(runs, [1, 2, 3, 4, 5, 6, 7, math.nan])
    with pytest.raises(ValueError, match="several runs have a = 1 and b = 1"):
        found.map("a", "b")
    assert "Largest: 7 at a 2, b 2" in Drawn(found.map("a", "b", at={"c": "x"})).description
    broken = Drawn(found.map("a", "b", at={"c": "y"}))
    assert "Runs without a number: 1." in broken.description and "a 2, b 2: it broke" in [e[0].text for e in broken.rectangles]
    assert "\N{MULTIPLICATION SIGN}" in [row[2] for row in broken.texts]
    assert "b 1, c y: 2" in [e[0].text for e in Drawn(found.map("b", "c", at={"a": 1})).rectangles]
    for arguments, error in ((("a", "nothing"), KeyError), (("a", "b", "nothing"), KeyError)):
        with pytest.raises(error, match="nothing"):
            found.map(*arguments)
    with pytest.raises(ValueError, match="no run"):
        found.map("a", "b", at={"c": "z"})
    with pytest.raises(ValueError, match="at most 100"):
        made([{"a": i, "b": 1} for i in range(101)], [0.0] * 101).map("a", "b")


def test_parallel_coordinates_draw_every_run(swept):
    drawn = Drawn(swept.parallel(by="lands"))
    columns = swept.columns()
    names = list(columns)
    assert names == ["gravity", "height", "lands", "low"] and len(drawn.lines) == 12
    places = [x for x, y, text in sorted(drawn.texts) if text in names and y == 70]
    for i, line in enumerate(drawn.lines):
        points = [tuple(map(float, point.split(","))) for point in line.get("points").split()]
        assert [x for x, _y in points] == places
        for name, (x, y) in zip(names, points, strict=True):
            value = drawn.scale(x + 6, along=1)(y)
            assert value == pytest.approx(columns[name][i], abs=2e-3 * (max(columns[name]) - min(columns[name])) + 1e-9), name
        assert line[0].text.startswith(f"gravity \N{MINUS SIGN}{-columns['gravity'][i]}, height {columns['height'][i]:g}, lands ")
    assert "12 runs" in drawn.description and "gravity: from \N{MINUS SIGN}20 to \N{MINUS SIGN}2." in drawn.description
    colours = {line.get("stroke"): x for line, x in zip(drawn.lines, swept["lands"], strict=True)}
    assert len(colours) == 12 and Drawn(swept.parallel(by="low")).lines[0].get("stroke") != drawn.lines[0].get("stroke")


def test_parallel_coordinates_of_texts_and_of_many_runs():
    found = made([{"kind": kind, "a": i} for i, kind in enumerate(("x", "y", "z", "x"))], [1, 2, math.nan, 4])
    drawn = Drawn(found.parallel())
    assert len(drawn.lines) == 3 and "Runs without a number: 1." in drawn.description and "kind: 3 values." in drawn.description
    first, last = (drawn.lines[i].get("points").split()[0] for i in (0, 2))
    assert first == last, "the same text is at the same place"
    many = Drawn(made([{"a": i, "b": i % 7} for i in range(5000)], list(range(5000))).parallel())
    assert len(many.lines) == 1667 and "One of 3 runs is drawn." in many.description


def test_a_notebook_displays_the_charts(swept):
    found = tags(swept)
    titles = [ElementTree.fromstring(svg)[0].text for svg in found.pictures]
    assert titles == ["Effects on lands", "Effects on low", "lands over gravity and height", "Runs by lands"]
    assert found.found.count("table") == 1
    one = tags(labspec.sweep(labspec.Lab(LAB), {"gravity": [-5, -10]}, MEASURES))
    assert one.pictures == [] and one.found.count("table") == 1
    three = made([{"a": i % 2, "b": i // 2 % 2, "c": i // 4} for i in range(8)], range(8))
    assert len(tags(three).pictures) == 2, "a map has two controls"


def test_labels_are_untrusted():
    for evil in (EVIL, "]]>", "\x00\x1b\ufffe\ud800", "\u202e" * 500, "&#x41;", ""):
        other = f"{evil}2"
        runs = [{evil: a, other: b} for a, b in itertools.product((1, 2), ("p", evil))]
        found = labspec.Sweep(tuple(runs), {evil: np.array([1.0, 2.0, 3.0, math.nan])}, (None, None, None, evil))
        tags(found)
        for svg in (found.tornado(), found.map(evil, other), found.parallel()):
            Drawn(svg)
            assert "<script" not in svg and "<img" not in svg


@pytest.mark.parametrize("numbers", [[math.nan] * 4, [0.0] * 4, [1e300, -1e300, math.inf, 1e308], [5e-324, 0, 1e-310, -0.0], [1e15, 1e15 + 1, 1e15 + 2, 1e15 + 3]])
def test_every_number_can_be_drawn(numbers):
    found = made([{"a": a, "b": b} for a, b in itertools.product((1, 2), (1, 2))], numbers)
    for svg in (found.tornado(), found.map("a", "b"), found.parallel()):
        Drawn(svg)
        assert "nan" not in svg and "inf" not in svg
    tags(found)
    empty = labspec.Sweep((), {"lands": np.array([])}, ())
    tags(empty)
    Drawn(empty.tornado())
    Drawn(empty.parallel())
    with pytest.raises(KeyError, match="no measure"):
        labspec.Sweep((), {}, ()).tornado()


def test_charts_have_the_same_bytes_in_another_process(swept):
    code = (
        f"import labspec, sys\nfound = labspec.sweep(labspec.Lab({LAB!r}), {GRID!r}, {MEASURES!r})\n"
        "sys.stdout.buffer.write((found.tornado() + found.map('gravity', 'height') + found.parallel()).encode())"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, env={"PYTHONHASHSEED": "7"}).stdout.decode()
    assert other == swept.tornado() + swept.map("gravity", "height") + swept.parallel()
