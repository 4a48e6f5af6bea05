"""How well a parameter is determined, and what accuracy costs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ._data import MS_PER_S, Floats, known, same_length
from ._style import BLUE, MARK, VERMILLION, finish, panel, series_marker, series_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_profile_likelihood(
    values: ArrayLike,
    errors: ArrayLike,
    *,
    best: float | None = None,
    threshold: float | None = None,
    label: str = "parameter",
    ax: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the smallest error E over a parameter that is held fixed, all others fitted anew.

    A deep valley determines the parameter, a flat floor does not. What is below the threshold is shaded.

    Args:
        values: of the parameter, increasing.
        errors: E at each; NaN or infinite where none was found, which leaves a gap.
        best: value of the parameter in the best fit, marked; None or NaN: none.
        threshold: E up to which a value is plausible; None or NaN: none.
        label: of the parameter with its unit, in the unit of `values`: "k3 [kN/m]".
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: the lengths differ or the values do not increase.
        ImportError: matplotlib is missing.

    Examples:
        >>> import numpy as np, crashsim
        >>> values = np.linspace(50.0, 250.0, 21)
        >>> errors = 0.03 + 1e-6 * (values - 131.0) ** 2
        >>> ax = crashsim.plots.plot_profile_likelihood(values, errors, best=131.0, threshold=0.033, label="k3 [kN/m]")
    """
    at, cost = same_length(values=values, errors=errors)
    if np.any(np.diff(at) <= 0):
        raise ValueError("values: must increase strictly; sort values and errors together")
    cost = np.where(np.isfinite(cost), cost, np.nan)
    limit, optimum = known(threshold), known(best)
    with panel(ax) as ax:
        ax.plot(at, cost, marker="o", markersize=3.5, label="profile", **series_style(0))
        if limit is not None:
            ax.axhline(limit, color=VERMILLION, linewidth=1.2, linestyle=(0, (5, 1.5)), label="threshold")
            x, y = _with_crossings(at, cost, limit)
            ax.fill_between(x, y, limit, where=y <= limit, color=BLUE, alpha=0.15, linewidth=0, label="plausible")
        if optimum is not None:
            ax.axvline(optimum, linestyle=(0, (4, 2)), label="best fit", **MARK)
        ax.set(xlabel=label, ylabel="error E")
        finish(ax, title)
    return ax


def _with_crossings(x: Floats, y: Floats, limit: float) -> tuple[Floats, Floats]:
    """The polyline with a point wherever it crosses `limit`."""
    before = np.flatnonzero((y[:-1] - limit) * (y[1:] - limit) < 0)
    share = (limit - y[before]) / (y[before + 1] - y[before])
    crossings = x[before] + share * (x[before + 1] - x[before])
    return np.insert(x, before + 1, crossings), np.insert(y, before + 1, limit)


def plot_work_precision(
    engines: Mapping[str, tuple[ArrayLike, ArrayLike]], *, ax: Axes | None = None, title: str | None = None
) -> Axes:
    """Draws the time [ms] that engines take over the error they achieve, both logarithmic: lower left is better.

    Args:
        engines: name -> (errors, seconds), a pair for each accuracy asked for. Pairs without a positive error and time
            cannot be shown and are left out.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: an engine's lengths differ, or there is no engine.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> engines = {"cvode": ([1e-3, 1e-5, 1e-8], [40e-6, 90e-6, 300e-6]), "taylor": ([1e-6, 1e-12], [9e-6, 15e-6])}
        >>> ax = crashsim.plots.plot_work_precision(engines)
    """
    if not engines:
        raise ValueError("engines: none given, need at least one")
    with panel(ax) as ax:
        for index, (name, (errors, seconds)) in enumerate(engines.items()):
            error, time = same_length(**{f"errors of {name}": errors, f"seconds of {name}": seconds})
            shown = (error > 0) & (time > 0) & np.isfinite(error) & np.isfinite(time)
            style = {**series_style(index), "marker": series_marker(index), "markersize": 5}
            ax.plot(error[shown], MS_PER_S * time[shown], label=name, **style)
        ax.set(xscale="log", yscale="log", xlabel="error achieved", ylabel="time [ms]")
        finish(ax, title)
    return ax
