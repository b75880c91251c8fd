"""Pictures as SVG, like those of the program: self-contained, without scripts and ids, and the same bytes for the same numbers. Labels are untrusted."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterable, Sequence
from html import escape

TITLE_COLOUR, LABEL_COLOUR, AXIS_COLOUR, GRID_COLOUR, NO_VALUE_COLOUR = "#222222", "#4d4d4d", "#7f7f7f", "#e3e3e3", "#f2f2f2"
#: Of Okabe and Ito, "Color Universal Design" (2008).
BLUE, RED, GREY = "#0072b2", "#d55e00", "#8c8c8c"
#: The colour map "viridis" at equal distances: its lightness grows evenly, so that it can be read without colours.
_VIRIDIS = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))
#: Larger numbers are drawn like no number, so that differences stay finite.
_HUGE = 1e300
#: Characters of a label.
_MOST_CHARACTERS = 160

Point = tuple[float, float]


def is_drawable(value: float) -> bool:
    """Whether a number has a place on an axis."""
    return math.isfinite(value) and abs(value) <= _HUGE


def short(value: object) -> str:
    """A value in words: a number with four significant digits, with an exponent if that is shorter."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    try:
        number = float(f"{value:.3e}")
    except OverflowError:
        return "not finite"
    if not math.isfinite(number):
        return "not finite"
    exponent = _exponent(number)
    if -4 <= exponent < 6:
        text = f"{number:.{max(0, 3 - exponent)}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
    else:
        mantissa = f"{number:.3e}".partition("e")[0].rstrip("0").rstrip(".")
        text = f"{mantissa}e{exponent}"
    return "0" if number == 0 else text.replace("-", "\N{MINUS SIGN}")


def _exponent(number: float) -> int:
    """The decimal exponent of a number: 0 of 5, -1 of 0.5. The logarithm of the platform is not used: its last bit differs."""
    return int(f"{abs(number):e}".partition("e")[2])


def fit(label: object, size: float, width: float) -> str:
    """A label on one line, cut where it is wider than ``width`` pixels."""
    text = "".join("\N{REPLACEMENT CHARACTER}" if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Cn") else c for c in str(label)[: _MOST_CHARACTERS + 1])
    if len(text) <= _MOST_CHARACTERS and text_width(text, size) <= width:
        return text.strip()
    while text and text_width(text + "…", size) > width:
        text = text[:-1]
    return text.strip() + "…"


def text_width(text: str, size: float) -> float:
    """The estimated width of a text, in pixels; rather too large."""
    return sum(1.0 if unicodedata.east_asian_width(c) in "WF" else 0.6 for c in text) * size


class Axis:
    """A linear axis between two pixels, for numbers or for values that are no numbers."""

    def __init__(self, values: Iterable[object], start: float, end: float) -> None:
        """An axis for these values. Those that are no numbers are placed at equal distances, in the order in which they come."""
        every = list(dict.fromkeys(values))
        numbers = [float(v) for v in every if isinstance(v, (int, float)) and not isinstance(v, bool)]
        self.start, self.end = start, end
        self.names: list[object] | None = every if len(numbers) < len(every) else None
        if self.names is not None:
            self.low, self.high = 0.0, float(max(1, len(self.names) - 1))
            return
        drawable = [x for x in numbers if is_drawable(x)] or [0.0]
        self.low, self.high = min(drawable), max(drawable)
        if self.low == self.high:
            margin = 0.1 * abs(self.low) or 1.0
            self.low, self.high = self.low - margin, self.high + margin

    def place(self, value: object) -> float:
        """The pixel of a value; NaN if it has none."""
        if self.names is not None:
            share = (self.names.index(value) if value in self.names else math.nan) / self.high
        else:
            number = float(value) if isinstance(value, (int, float)) else math.nan
            share = (number - self.low) / (self.high - self.low) if is_drawable(number) else math.nan
        return self.start + share * (self.end - self.start)

    def ticks(self, count: int = 5) -> list[tuple[float, str]]:
        """The pixels and the labels of round values, about ``count``."""
        if self.names is not None:
            return [(self.place(name), short(name)) for name in self.names]
        rough = (self.high - self.low) / count
        exponent = _exponent(rough)
        leading = rough / float(f"1e{exponent}") - 1e-9
        factor, exponent = next(((n, exponent) for n in (1, 2, 5) if leading <= n), (1, exponent + 1))
        step = float(f"{factor}e{exponent}")
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        if abs(first) > 10**6 or abs(last) > 10**6:
            return [(self.place(x), short(x)) for x in (self.low, self.high)]
        values = [float(f"{i * factor}e{exponent}") for i in range(first, last + 1)]
        return [(self.place(value), short(value)) for value in values]


def colour(share: float) -> str:
    """The colour of a share from 0 to 1."""
    at = min(1.0, max(0.0, share)) * (len(_VIRIDIS) - 1)
    i = min(int(at), len(_VIRIDIS) - 2)
    parts = (round(a + (at - i) * (b - a)) for a, b in zip(_VIRIDIS[i], _VIRIDIS[i + 1], strict=True))
    return "#" + "".join(f"{part:02x}" for part in parts)


class Picture:
    """A picture with a title, and a description for those who do not see it."""

    def __init__(self, title: str, description: str, width: float, height: float) -> None:
        self._head = (title, description)
        self.width, self.height = width, height
        self._parts: list[str] = []

    def text(self, at: Point, text: str, *, size: float = 12, anchor: str = "start", colour: str = LABEL_COLOUR, halo: bool = False) -> None:
        """Writes a text; ``at`` is the start, the middle or the end of its base line. A halo keeps it readable on lines."""
        x, y = at
        style = ' stroke="#ffffff" stroke-width="3" paint-order="stroke"' * halo
        place = f'x="{_px(x)}" y="{_px(y)}" font-size="{_px(size)}" text-anchor="{anchor}"'
        self._parts.append(f'<text {place} fill="{colour}"{style}>{_escaped(text)}</text>')

    def rectangle(self, at: Point, size: Point, fill: str, name: str = "") -> None:
        """Draws a filled rectangle, with what it means."""
        (x, y), (width, height) = at, size
        box = f'<rect x="{_px(x)}" y="{_px(y)}" width="{_px(width)}" height="{_px(height)}" fill="{fill}"'
        self._parts.append(box + (f"><title>{_escaped(name)}</title></rect>" if name else "/>"))

    def line(self, points: Sequence[Point], stroke: str, name: str = "", *, width: float = 1, opacity: float = 1, dash: str = "") -> None:
        """Draws a line through points, with what it means."""
        path = " ".join(f"{_px(x)},{_px(y)}" for x, y in points)
        style = f' stroke-opacity="{_px(opacity)}"' * (opacity < 1) + f' stroke-dasharray="{dash}"' * bool(dash)
        line = f'<polyline points="{path}" fill="none" stroke="{stroke}" stroke-width="{_px(width)}"{style}'
        self._parts.append(line + (f"><title>{_escaped(name)}</title></polyline>" if name else "/>"))

    def heading(self) -> None:
        """Writes the title into the picture."""
        self.text((12, 24), fit(self._head[0], 14, self.width - 24), size=14, colour=TITLE_COLOUR)

    def svg(self) -> str:
        """The picture."""
        title, description = (_escaped(one) for one in self._head)
        size = f'width="{_px(self.width)}" height="{_px(self.height)}" viewBox="0 0 {_px(self.width)} {_px(self.height)}"'
        start = f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" font-family="Helvetica, Arial, \'Liberation Sans\', \'DejaVu Sans\', sans-serif">'
        background = f'<rect width="{_px(self.width)}" height="{_px(self.height)}" fill="#ffffff"/>'
        lines = [start, f"<title>{title}</title>", f"<desc>{description}</desc>", background, *self._parts]
        return "\n  ".join(lines) + "\n</svg>\n"


def _px(x: float) -> str:
    text = f"{x:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _escaped(text: str) -> str:
    """Text for XML, without characters that it forbids."""
    kept = "".join("\N{REPLACEMENT CHARACTER}" if unicodedata.category(c) in ("Cc", "Cs", "Cn") else c for c in text)
    return escape(kept, quote=True)
