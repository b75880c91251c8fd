"""A lab in a notebook: the element of the page as a widget of anywidget (``pip install labspec[widget]``)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._files import files_of
from ._lab import Lab

#: The script of the elements, in one file.
_NAME = "labspec-elements.js"


def show(lab: Lab, *, esm: str | os.PathLike[str] | None = None) -> Any:
    """The lab as on a page: in JupyterLab, marimo and Colab, it plays in the notebook.

    It starts as it was opened; what is done to it stays in the page. ``esm`` is the path of ``labspec-elements.js``; by default that of the environment
    variable ``LABSPEC_ELEMENTS``, or the one beside this package, or the one that ``web/elements`` has built.
    """
    try:
        from .widget import LabWidget
    except ImportError as e:
        raise ImportError("a widget needs the package anywidget: pip install labspec[widget]") from e
    return LabWidget(lab=lab.json, models=_models(lab), esm=_script(esm))


def _script(given: str | os.PathLike[str] | None) -> str:
    """The text of the script."""
    named = given if given is not None else os.environ.get("LABSPEC_ELEMENTS")
    here = Path(__file__).resolve()
    built = [folder / "web/elements/dist" / _NAME for folder in here.parents[1:6]]
    places = [Path(named)] if named is not None else [here.with_name(_NAME), *built]
    for place in places:
        if place.is_file():
            return place.read_text(encoding="utf-8")
    raise FileNotFoundError(
        f"{_NAME} is not at {', '.join(map(str, places[:2]))}: build it in the repository of labspec with "
        "`cargo run --release --manifest-path bindings/xtask/Cargo.toml` and `npm run build` in web/elements, and name it with "
        "`esm=` or LABSPEC_ELEMENTS"
    )


def _models(lab: Lab) -> dict[str, str | bytes]:
    """The model of the lab, and the files that it names."""
    given, source = lab._source[-1], lab.json
    if isinstance(given, Mapping):
        return dict(given)
    if given is None:
        return {}
    folder, name = Path(given), source.get("model")
    if isinstance(name, str):
        text = (folder / f"{name}.xml").read_text(encoding="utf-8")
        return {name: text, **_by_name(files_of(text, folder))}
    xml = source.get("xml")
    return _by_name(files_of(xml, folder)) if isinstance(xml, str) else {}


def _by_name(files: Mapping[str, bytes]) -> dict[str, str | bytes]:
    """Files as a page takes them: MJCF by its name, without the extension, everything else by its path."""
    found: dict[str, str | bytes] = {}
    for path, content in files.items():
        if path.endswith(".xml"):
            found[path.removesuffix(".xml")] = content.decode("utf-8", "replace")
        else:
            found[path] = content
    return found
