"""Force over crush, and the ledger of energy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._data import CRUSH_LABEL, MM_PER_M, MS_PER_S, TIME_LABEL, Floats, columns, known, named
from ._style import BLUE, DASHES, GREEN, MARK, PURPLE, TEST, VERMILLION, finish, mark_time, panel, series_style
from ._types import ForceMotion, MassMotion, OneOrMany

if TYPE_CHECKING:
    from matplotlib.axes import Axes

KILO = 1e-3


def plot_force_crush(
    test: MassMotion | None,
    model: OneOrMany[ForceMotion] | None = None,
    *,
    mass_kg: float | None = None,
    end_time_s: float | None = None,
    ax: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the crush force [kN] over crush [mm]: -m a of the test and the force of one or several models.

    Of a single model spring and damper are drawn as well.

    Args:
        test: measured motion; None draws models only.
        model: response, several, or a mapping from names for the legend to responses; None draws the test only.
        mass_kg: mass of the test [kg]; None: its own.
        end_time_s: where curves end [s]; None: each at its t_m, or with its last sample when it has none.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, there is neither test nor model, or the test's mass is not known.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0], [5e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper, impact_speed_mps=13.9)
        >>> ax = crashsim.plots.plot_force_crush(None, crashsim.simulate(model))
    """
    if test is None and model is None:
        raise ValueError("test, model: neither is given, need at least one")
    with panel(ax) as ax:
        if test is not None:
            mass = _mass(test, mass_kg)
            _, accel, crush = columns(test, "time_s", "accel_mps2", "displacement_m", end_time_s=_end(test, end_time_s))
            ax.plot(MM_PER_M * crush, -KILO * mass * accel, label="test, $-m\\,a$", **TEST)
        if model is not None:
            _draw_models(ax, named(model, "model"), end_time_s)
        ax.set(xlabel=CRUSH_LABEL, ylabel="force [kN]")
        finish(ax, title)
    return ax


def _draw_models(ax: Axes, models: list[tuple[str, ForceMotion]], end_time_s: float | None) -> None:
    names = ("time_s", "displacement_m", "spring_force_n", "damper_force_n")
    for index, (label, motion) in enumerate(models):
        _, crush, spring, damper = columns(motion, *names, end_time_s=_end(motion, end_time_s))
        ax.plot(MM_PER_M * crush, KILO * (spring + damper), label=label, **series_style(index))
        if len(models) == 1:
            ax.plot(MM_PER_M * crush, KILO * spring, label="spring", **series_style(1))
            ax.plot(MM_PER_M * crush, KILO * damper, label="damper", **series_style(2))


def _mass(test: MassMotion, mass_kg: float | None) -> float:
    mass = known(test.mass_kg if mass_kg is None else mass_kg)
    if mass is None:
        raise ValueError("test.mass_kg: unset, must be known for the force -m a; give mass_kg=")
    return mass


def _end(motion: ForceMotion | MassMotion, end_time_s: float | None) -> float | None:
    return known(motion.t_m_s) if end_time_s is None else end_time_s


def plot_energy(response: ForceMotion, mass_kg: float, *, ax: Axes | None = None, title: str | None = None) -> Axes:
    """Draws where the kinetic energy of impact goes [kJ] over time [ms]: motion, spring, damper, their sum, residual.

    The work of spring and damper is the integral of their forces over the samples, by trapezoids. The residual is the
    simulation's own.

    Args:
        response: simulated crush.
        mass_kg: of its model [kg].
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, or the mass is not > 0.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0], [5e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper, impact_speed_mps=13.9)
        >>> ax = crashsim.plots.plot_energy(crashsim.simulate(model), model.mass_kg)
    """
    if not mass_kg > 0:
        raise ValueError(f"mass_kg = {mass_kg} kg: must be > 0")
    names = ("time_s", "displacement_m", "velocity_mps", "spring_force_n", "damper_force_n", "energy_residual_j")
    time, crush, velocity, spring, damper, residual = columns(response, *names)
    kinetic, stored, dissipated = mass_kg * velocity**2 / 2, _work(spring, crush), _work(damper, crush)
    largest = np.max(np.abs(residual), initial=0.0)
    ledger = (
        ("sum", kinetic + stored + dissipated, {**MARK, "linewidth": 1.2}),
        ("kinetic", kinetic, {"color": BLUE}),
        ("spring", stored, {"color": VERMILLION, "linestyle": DASHES[1]}),
        ("damper", dissipated, {"color": GREEN, "linestyle": DASHES[2]}),
        (f"residual \u2264 {largest:.1g} J", residual, {"color": PURPLE, "linestyle": DASHES[3]}),
    )
    with panel(ax) as ax:
        for label, energy, style in ledger:
            ax.plot(MS_PER_S * time, KILO * energy, label=label, **{"linewidth": 1.5, **style})
        mark_time(ax, response.t_m_s, "$t_m$")
        ax.set(xlabel=TIME_LABEL, ylabel="energy [kJ]")
        finish(ax, title)
    return ax


def _work(force: Floats, crush: Floats) -> Floats:
    steps = (force[1:] + force[:-1]) / 2 * np.diff(crush)
    return np.concatenate((np.zeros(min(len(force), 1)), np.cumsum(steps)))
