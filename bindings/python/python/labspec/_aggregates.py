"""What becomes of an expression over all samples of a run: the table "Measures" of docs/verify.md, for runs of another engine."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

#: The value of argument `i` at the current sample, as a number; NaN if it is none.
Argument = Callable[[int], float]


def _holds(x: float) -> bool:
    """Whether a condition holds: NaN does not."""
    return x != 0 and not math.isnan(x)


@dataclass
class Running:
    """An aggregate during a run. ``sample`` is called at every sample, with the time in s; ``result`` is its value up to then."""

    result: float = math.nan

    def sample(self, arg: Argument, time: float) -> None:
        """Takes a sample."""
        raise NotImplementedError


@dataclass
class _First(Running):
    def sample(self, arg: Argument, time: float) -> None:
        if math.isnan(self.result) and _holds(arg(0)):
            self.result = time


@dataclass
class _At(Running):
    done: bool = False

    def sample(self, arg: Argument, time: float) -> None:
        if not self.done and _holds(arg(0)):
            self.result, self.done = arg(1), True


@dataclass
class _Before(Running):
    was: float = math.nan
    done: bool = False

    def sample(self, arg: Argument, time: float) -> None:
        if self.done:
            return
        if _holds(arg(0)):
            self.result, self.done = self.was, True
        else:
            self.was = arg(1)


@dataclass
class _Initial(Running):
    done: bool = False

    def sample(self, arg: Argument, time: float) -> None:
        if not self.done:
            self.result, self.done = arg(0), True


@dataclass
class _Final(Running):
    def sample(self, arg: Argument, time: float) -> None:
        self.result = arg(0)


@dataclass
class _Extreme(Running):
    sign: float = 1.0

    def sample(self, arg: Argument, time: float) -> None:
        x = arg(0)
        if math.isnan(self.result) or self.sign * x > self.sign * self.result:
            self.result = x


@dataclass
class _Min(_Extreme):
    sign: float = -1.0


@dataclass
class _Previous(Running):
    now: float = math.nan

    def sample(self, arg: Argument, time: float) -> None:
        self.result, self.now = self.now, arg(0)


@dataclass
class _Last(Running):
    def sample(self, arg: Argument, time: float) -> None:
        if _holds(arg(0)):
            self.result = time


@dataclass
class _Holds(Running):
    result: float = 1.0

    def sample(self, arg: Argument, time: float) -> None:
        if not _holds(arg(0)):
            self.result = 0.0


@dataclass
class _Count(Running):
    result: float = 0.0
    was: bool = False

    def sample(self, arg: Argument, time: float) -> None:
        now = _holds(arg(0))
        self.result += now and not self.was
        self.was = now


@dataclass
class _Peak(Running):
    top: float = math.nan

    def sample(self, arg: Argument, time: float) -> None:
        x = arg(0)
        if x > self.top or (math.isnan(self.top) and not math.isnan(x)):
            self.result, self.top = time, x


@dataclass
class _Settles(Running):
    def sample(self, arg: Argument, time: float) -> None:
        if not abs(arg(0) - arg(1)) <= arg(2):
            self.result = math.nan
        elif math.isnan(self.result):
            self.result = time


@dataclass
class _Integral(Running):
    """The area under a curve, by trapezoids."""

    area: float = 0.0
    covered: float = 0.0
    time: float = math.nan
    x: float = math.nan

    def of(self, x: float) -> float:
        """The integrand."""
        return x

    def end(self) -> float:
        """The result."""
        return self.area

    def sample(self, arg: Argument, time: float) -> None:
        x = self.of(arg(0))
        if self.time < time:
            self.area += 0.5 * (self.x + x) * (time - self.time)
            self.covered += time - self.time
        self.time, self.x = time, x
        self.result = self.end()


@dataclass
class _Mean(_Integral):
    def end(self) -> float:
        return self.area / self.covered if self.covered > 0 else self.x


@dataclass
class _Rms(_Mean):
    def of(self, x: float) -> float:
        return x * x

    def end(self) -> float:
        mean = super().end()
        return math.sqrt(mean) if mean >= 0 else math.nan


@dataclass
class _Rate(Running):
    """The slope of the straight line through all samples."""

    times: list[float] = field(default_factory=list)
    values: list[float] = field(default_factory=list)

    def sample(self, arg: Argument, time: float) -> None:
        self.times.append(time)
        self.values.append(arg(0))

    @property
    def slope(self) -> float:
        """The slope, by least squares."""
        n = len(self.times)
        mean_time, mean = math.fsum(self.times) / n, sum(self.values) / n
        square = sum((t - mean_time) ** 2 for t in self.times)
        return sum((t - mean_time) * (x - mean) for t, x in zip(self.times, self.values, strict=True)) / square if square > 0 else math.nan


@dataclass
class _Crossing(Running):
    """Passages of zero, or of a level. ``before`` is the last sample: its time and its distance from the level."""

    levels: bool = False
    before: tuple[float, float] | None = None

    def distance(self, arg: Argument) -> float:
        """The distance from the level."""
        return arg(0) - (arg(1) if self.levels else 0.0)

    @staticmethod
    def zero(before: tuple[float, float], time: float, x: float) -> float:
        """The time of the zero of the line through two samples."""
        then, was = before
        return then + (time - then) * (was / (was - x))

    def sample(self, arg: Argument, time: float) -> None:
        if not math.isnan(self.result):
            return
        x, before = self.distance(arg), self.before
        if x == 0:
            self.result = time
        elif before is not None and before[0] < time and before[1] * x < 0:
            self.result = self.zero(before, time, x)
        self.before = (time, x)


@dataclass
class _Crossings(_Crossing):
    result: float = 0.0
    side: float = 0.0
    time: float = -math.inf

    def sample(self, arg: Argument, time: float) -> None:
        x = self.distance(arg)
        if math.isnan(x) or self.time > time:
            self.side = 0.0
        elif x != 0:
            self.result += self.side * x < 0
            self.side = math.copysign(1.0, x)
        self.time = time


@dataclass
class _Period(_Crossing):
    below: bool = False
    reached: float | None = None
    ups: list[float] = field(default_factory=list)

    def sample(self, arg: Argument, time: float) -> None:
        x, before = self.distance(arg), self.before
        if before is None or not before[0] < time or math.isnan(x):
            self.below, self.reached = False, None
        if x < 0:
            self.below, self.reached = True, None
        if x == 0 and self.below and self.reached is None:
            self.reached = time
        if x > 0:
            if self.below and before is not None and (self.reached is not None or before[1] < 0):
                self.ups.append(self.zero(before, time, x) if self.reached is None else self.reached)
            self.below, self.reached = False, None
        self.before = (time, x)
        if len(self.ups) > 1:
            self.result = (self.ups[-1] - self.ups[0]) / (len(self.ups) - 1)


_KINDS: dict[str, type[Running]] = {
    "first": _First,
    "at": _At,
    "before": _Before,
    "initial": _Initial,
    "final": _Final,
    "min": _Min,
    "max": _Extreme,
    "previous": _Previous,
    "last": _Last,
    "holds": _Holds,
    "count": _Count,
    "peak": _Peak,
    "settles": _Settles,
    "integral": _Integral,
    "mean": _Mean,
    "rms": _Rms,
    "rate": _Rate,
    "crossing": _Crossing,
    "crossings": _Crossings,
    "period": _Period,
}


def running(name: str, arguments: int) -> Running:
    """An aggregate before the first sample.

    ``NotImplementedError`` if this module does not have it.
    """
    kind = _KINDS.get(name)
    if kind is None:
        raise NotImplementedError(f"`{name}` is not evaluated over runs of another engine")
    made = kind()
    if isinstance(made, _Crossing):
        made.levels = arguments > 1
    return made


def result_of(one: Running) -> float:
    """The value of an aggregate up to the last sample."""
    return one.slope if isinstance(one, _Rate) and one.times else one.result
