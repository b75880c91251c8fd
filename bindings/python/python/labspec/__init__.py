"""Labs, models and checks of physics lessons, with the numbers that ``labspec check`` verifies.

>>> import labspec
>>> model = labspec.Model.from_xml("<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>")
>>> data = labspec.Data(model)
>>> data.step(100)
>>> round(float(data.qpos[2]), 4)
0.8018
"""

# First: it chooses the module that all others import.
from . import _processor as _processor
from ._check import Claim, Finding, Measured, Report, Verification, check
from ._compare import EngineComparison, EngineRow, compare_engines
from ._designs import latin_hypercube, sobol
from ._effects import Effect, Effects
from ._engine import Data, Model
from ._lab import Control, Lab
from ._labspec import LabspecError, __VERSION__ as __version__
from ._mujoco import MujocoLab
from ._recording import Displayed, Recording, Run
from ._reports import Fault, Margin, Precision, PrecisionRow, Stability
from ._sweep import Sweep, sweep
from ._widget import show

__all__ = [
    "Claim",
    "Control",
    "Data",
    "Displayed",
    "Effect",
    "Effects",
    "EngineComparison",
    "EngineRow",
    "Fault",
    "Finding",
    "Lab",
    "LabspecError",
    "Margin",
    "Measured",
    "Model",
    "MujocoLab",
    "Precision",
    "PrecisionRow",
    "Recording",
    "Report",
    "Run",
    "Stability",
    "Sweep",
    "Verification",
    "__version__",
    "check",
    "compare_engines",
    "latin_hypercube",
    "show",
    "sobol",
    "sweep",
]
