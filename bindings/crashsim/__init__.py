"""Vehicle crash simulation: traces in, a model of the front end out.

Read a trace, make a crash pulse of it, identify a lumped-parameter model, simulate crush, heave and pitch, and judge
the model against the test::

    import crashsim

    pulse = crashsim.read_pulse("C56.csv", channels=["LEFT_REAR_VX", "RIGHT_REAR_VX"])
    fit = crashsim.identify(pulse, starts=100, seed=1)
    run = crashsim.simulate(fit.model, impact_speed_mps="48 km/h")

Everything inside is in SI units and names carry them; text such as ``"56 km/h"`` is taken wherever a number is an
option. Errors that a caller can mend are `InvalidInput`, a `ValueError`. What a careful reader should know of an input
is in the results' ``warnings`` and goes to the logger ``crashsim``.
"""

from __future__ import annotations

import logging as _logging
from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import _core
from ._batch import RayExecutor as RayExecutor
from ._batch import run_batch as run_batch
from ._core import *  # noqa: F403  (its __all__ is the engine's public names)
from ._display import adorn as _adorn

if _TYPE_CHECKING:
    from . import plots as plots
    from ._report import report as report

__version__: str = _core.__version__
__all__ = ["RayExecutor", "__version__", "plots", "report", "run_batch"]
__all__ += _core.__all__

_logging.getLogger(__name__).addHandler(_logging.NullHandler())
_adorn(_core)


def __getattr__(name: str) -> object:
    """Loads what needs optional packages when it is first used."""
    import importlib

    if name == "report":
        return importlib.import_module("._report", __name__).report
    if name == "plots":
        return importlib.import_module(".plots", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
