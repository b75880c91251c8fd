"""The class of :func:`labspec.show`. It needs the package ``anywidget``."""

from __future__ import annotations

from typing import Any

import anywidget
import traitlets


class LabWidget(anywidget.AnyWidget):
    """A lab that plays in a notebook. Another lab in the trait ``lab`` replaces it."""

    #: The lab in the lab format.
    lab = traitlets.Dict().tag(sync=True)
    #: MJCF by name, and other files by path.
    models = traitlets.Dict().tag(sync=True)

    def __init__(self, *, lab: dict[str, Any], models: dict[str, str | bytes], esm: str) -> None:
        """Makes the widget with the text of the script of the elements."""
        self._esm = esm
        super().__init__(lab=lab, models=models)
