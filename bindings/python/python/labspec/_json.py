"""Reports of the program: numbers that JSON cannot represent."""

from __future__ import annotations

import json
from typing import Any


def with_all_numbers(value: Any) -> Any:
    """A part of a report, in which NaN and infinities stand at their places instead of ``null``, and ``nonfinite`` is gone."""
    if isinstance(value, list):
        return [with_all_numbers(one) for one in value]
    if not isinstance(value, dict):
        return value
    found = {key: with_all_numbers(one) for key, one in value.items() if key != "nonfinite"}
    for key, names in value.get("nonfinite", {}).items():
        if isinstance(names, str):
            found[key] = float(names)
        else:
            for index, name in names:
                found[key][index] = float(name)
    return found


def loads(text: str) -> dict[str, Any]:
    """A report as a dictionary."""
    report: dict[str, Any] = json.loads(text)
    return report
