"""Designs of experiments over the sliders of a lab: Sobol sequences and Latin hypercubes. They need ``scipy`` (``pip install labspec[designs]``)."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any

from ._lab import Control, Lab


def sobol(lab: Lab, runs: int, sliders: Sequence[str] | None = None, *, seed: int = 0) -> list[dict[str, float]]:
    """Values of sliders for runs, from a scrambled Sobol sequence; a power of two of them is balanced.

    ``sliders`` are labels; by default all sliders of the lab. The values lie on the steps of the sliders. A seed gives the same runs again.
    """
    return _design("Sobol", lab, runs, sliders, seed)


def latin_hypercube(lab: Lab, runs: int, sliders: Sequence[str] | None = None, *, seed: int = 0) -> list[dict[str, float]]:
    """Values of sliders for runs, from a Latin hypercube: each slider has one value in each of ``runs`` equal parts of its range."""
    return _design("LatinHypercube", lab, runs, sliders, seed)


def _design(name: str, lab: Lab, runs: int, labels: Sequence[str] | None, seed: int) -> list[dict[str, float]]:
    try:
        qmc: Any = import_module("scipy.stats.qmc")
    except ImportError as e:
        raise ImportError("designs need the package scipy: pip install labspec[designs]") from e
    known = {c.label: c for c in lab.controls if c.kind == "slider"}
    chosen = list(known) if labels is None else list(labels)
    unknown = [label for label in chosen if label not in known]
    if unknown:
        raise KeyError(f'"{unknown[0]}" is not a slider of the lab')
    if runs < 1 or not chosen:
        raise ValueError("a design needs at least one run and one slider")
    engine: Any = getattr(qmc, name)(d=len(chosen), rng=seed)
    points = engine.random(runs)
    return [{label: _placed(known[label], float(x)) for label, x in zip(chosen, row, strict=True)} for row in points]


def _placed(slider: Control, share: float) -> float:
    """The step of a slider at a share of its range."""
    low, high = float(slider.min or 0), float(slider.max or 0)
    step = float(slider.step or (high - low) / 100)
    return min(high, low + step * round(share * (high - low) / step))
