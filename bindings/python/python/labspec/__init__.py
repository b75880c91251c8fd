"""Labs, models and checks of physics lessons, with the numbers that ``labspec check`` verifies.

>>> import labspec
>>> model = labspec.Model.from_xml("<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>")
>>> data = labspec.Data(model)
>>> data.step(100)
>>> round(float(data.qpos[2]), 4)
0.8018
"""

from ._check import Claim, Finding, Report, check
from ._engine import Data, Model
from ._lab import Control, Displayed, Lab, Recording
from ._labspec import LabspecError, __VERSION__ as __version__
from ._sweep import Sweep, sweep

__all__ = [
    "Claim",
    "Control",
    "Data",
    "Displayed",
    "Finding",
    "Lab",
    "LabspecError",
    "Model",
    "Recording",
    "Report",
    "Sweep",
    "__version__",
    "check",
    "sweep",
]
