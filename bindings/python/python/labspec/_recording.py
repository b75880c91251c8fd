"""What a run of a lab gives: its measures, and the displayed values at its samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _html

if TYPE_CHECKING:
    from ._lab import Lab

Value = float | str | bool


@dataclass(frozen=True)
class Displayed:
    """A trace of a plot, or a readout."""

    label: str
    unit: str
    kind: str
    #: The plot of a trace, from 0.
    plot: int | None
    #: The decimals of a readout.
    digits: int | None


@dataclass(frozen=True)
class Recording:
    """The displayed values of a run: a row for each sample, a column for each value; NaN where a value is no number."""

    times: NDArray[np.float64]
    values: NDArray[np.float64]
    displayed: tuple[Displayed, ...]
    #: The lab that was recorded.
    lab: Lab | None = field(default=None, repr=False, compare=False)

    def plots(self) -> tuple[str, ...]:
        """The plots of the lab as SVG, as ``labspec run --svg`` draws them."""
        if self.lab is None:
            return ()
        rows = np.column_stack([self.times, self.values])
        return tuple(self.lab._native.draw(np.ascontiguousarray(rows, np.float64).ravel()))

    def _repr_html_(self) -> str:
        last = zip(self.displayed, self.values[-1] if len(self) else (), strict=False)
        heading = _html.heading("Recording", f"{len(self)} samples" + (f" until {self.times[-1]:g} s" if len(self) else ""))
        pictures = "".join(_html.picture(svg, f"plot {i}") for i, svg in enumerate(self.plots(), 1))
        return heading + pictures + _html.table(["", "at the end", "unit"], [[d.label, float(x), d.unit] for d, x in last])

    def __getitem__(self, label: str) -> NDArray[np.float64]:
        """The column with this label."""
        for i, displayed in enumerate(self.displayed):
            if displayed.label == label:
                return self.values[:, i]
        raise KeyError(f'nothing is displayed as "{label}"; use one of {", ".join(d.label for d in self.displayed)}')

    def __len__(self) -> int:
        return len(self.times)


@dataclass(frozen=True)
class Run:
    """A run of a lab: the values of the controls, the measures, and why it has none."""

    params: Mapping[str, Value]
    #: NaN where the run has no measures.
    values: Mapping[str, float]
    error: str | None = None
    #: The displayed values, if they were recorded.
    recording: Recording | None = None

    def __getitem__(self, measure: str) -> float:
        """A measure."""
        return self.values[measure]

    def _repr_html_(self) -> str:
        heading = _html.heading("Run", ", ".join(f"{label} = {_html.plain(value)}" for label, value in self.params.items()), self.error or "")
        measures = _html.table(["measure", "value"], list(self.values.items()))
        return heading + measures + (self.recording._repr_html_() if self.recording is not None else "")
