"""Pictures of pulses, models and results with matplotlib: axes in, axes out.

Every function draws into the axes it is given and nowhere else, and leaves their style alone; without axes it makes a
figure in a style of its own, as wide as `matplotlib.rcParams["figure.figsize"]` says. matplotlib's settings are never
changed. For a column of 85 mm:

    with matplotlib.rc_context({"figure.figsize": (3.35, 2.5)}):
        ax = crashsim.plots.plot_spring(model)

Colours are told apart by colour-blind readers, line styles and markers in grey print. Arrays are in SI units, axes in
ms, g, mm, kN, km/h, kJ and degrees. What is unset (NaN) is not drawn.
"""

from ._curves import plot_damper, plot_model, plot_spring
from ._forces import plot_energy, plot_force_crush
from ._motion import plot_fit, plot_prediction, plot_pulse, plot_response
from ._pitch import plot_pitch
from ._starts import plot_start_parameters, plot_starts
from ._study import plot_profile_likelihood, plot_work_precision

__all__ = [
    "plot_damper",
    "plot_energy",
    "plot_fit",
    "plot_force_crush",
    "plot_model",
    "plot_pitch",
    "plot_prediction",
    "plot_profile_likelihood",
    "plot_pulse",
    "plot_response",
    "plot_spring",
    "plot_start_parameters",
    "plot_starts",
    "plot_work_precision",
]
