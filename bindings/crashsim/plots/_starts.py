"""Where the starts of an identification ended."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ._data import Floats, vector
from ._style import BLUE, VERMILLION, add_colorbar, finish, label_log_axis, panel, sequential_map, set_categories
from ._types import Multistart

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AT_BEST = 1.001


def plot_starts(fit: Multistart, *, ax: Axes | None = None, title: str | None = None) -> Axes:
    """Draws the error E that each start reached, sorted: a long flat foot means that many starts agree.

    Starts within 0.1 % of the best are filled dots. Starts that failed are counted in the legend.

    Args:
        fit: identification with its `starts`.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ImportError: matplotlib is missing.

    Examples:
        >>> import numpy as np, crashsim
        >>> time_s = np.linspace(0.0, 0.12, 1201)
        >>> accel_mps2 = -300.0 * np.sin(np.pi * np.minimum(time_s / 0.09, 1.0))
        >>> pulse = crashsim.make_pulse(time_s, accel_mps2, impact_speed_mps=15.6, mass_kg=1190.0)
        >>> ax = crashsim.plots.plot_starts(crashsim.identify(pulse, starts=8))
    """
    errors = np.array([start.error for start in fit.starts], dtype=np.float64)
    reached = np.sort(errors[np.isfinite(errors)])
    rank = np.arange(1, len(reached) + 1)
    best = reached <= AT_BEST * reached[:1] if len(reached) else np.zeros(0, dtype=bool)
    failed = len(errors) - len(reached)
    with panel(ax) as ax:
        from matplotlib.ticker import MaxNLocator

        ax.plot(rank[best], reached[best], "o", color=BLUE, markersize=4, label=f"within 0.1 % of best: {best.sum()}")
        if not best.all():
            label = f"others: {np.sum(~best)}"
            ax.plot(rank[~best], reached[~best], "s", color=VERMILLION, markersize=4, fillstyle="none", label=label)
        if failed:
            ax.plot([], [], linestyle="none", label=f"failed: {failed}")
        if len(reached) and reached[0] > 0:
            ax.set_yscale("log")
            label_log_axis(ax)
        ax.set(xlabel="start, sorted by error", ylabel="error E")
        ax.xaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], integer=True))
        finish(ax, title)
    return ax


def plot_start_parameters(
    parameters: ArrayLike,
    errors: ArrayLike,
    *,
    names: Sequence[str] | None = None,
    scale: ArrayLike | None = None,
    ax: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws where the starts ended: each parameter over its scale, coloured by the error E; the best start as a line.

    Args:
        parameters: one row for each start, one column for each parameter.
        errors: E of each start; those that are not finite are left out.
        names: of the parameters, shown below them.
        scale: what each parameter is divided by, such as its upper bound; None: its largest magnitude of all starts.
        ax: axes to draw into; None makes a figure. The colour bar is inside their right margin.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: the shapes do not agree.
        ImportError: matplotlib is missing.

    Examples:
        >>> import numpy as np, crashsim
        >>> errors = 0.03 * (1 + np.linspace(0.0, 1.0, 20) ** 2)
        >>> parameters = [4e5, 2e5, 9e3] * (1 + np.outer(np.linspace(-0.5, 0.5, 20), [0.1, 0.8, 0.3]))
        >>> ax = crashsim.plots.plot_start_parameters(parameters, errors, names=["k1", "k2", "c1"])
    """
    table, costs, labels = _starts_table(parameters, errors, names)
    sizes = np.fmax.reduce(np.abs(table), axis=0, initial=0.0) if scale is None else vector(scale, "scale")
    if len(sizes) != len(labels):
        raise ValueError(f"scale: has {len(sizes)} values and parameters has {len(labels)} columns, must be as many")
    order = np.argsort(-costs, kind="stable")
    norm = "log" if len(costs) and costs.min() > 0 else "linear"
    shares = table[order] / np.where(sizes == 0, 1.0, sizes)
    with panel(ax) as ax:
        places = np.arange(len(labels))
        spread = np.linspace(-0.25, 0.25, len(shares))[:, np.newaxis]
        x = np.broadcast_to(places + spread, shares.shape)
        color = np.broadcast_to(costs[order][:, np.newaxis], shares.shape)
        dots = ax.scatter(x.ravel(), shares.ravel(), c=color.ravel(), cmap=sequential_map(), norm=norm, s=9)
        if len(shares):
            ax.hlines(shares[-1], places - 0.35, places + 0.35, color=VERMILLION, linewidth=1.5, label="best start")
            add_colorbar(ax, dots, "error E", log=norm == "log")
        set_categories(ax, labels)
        ax.set_ylabel("parameter / largest" if scale is None else "parameter / scale")
        finish(ax, title)
    return ax


def _starts_table(
    parameters: ArrayLike, errors: ArrayLike, names: Sequence[str] | None
) -> tuple[Floats, Floats, list[str]]:
    """Rows of the starts with a finite error, their errors, and a name for each column."""
    table, costs = np.asarray(parameters, dtype=np.float64), vector(errors, "errors")
    if table.ndim != 2 or len(table) != len(costs):
        raise ValueError(f"parameters: has shape {table.shape}, must have a row for each of the {len(costs)} errors")
    labels = [f"p{i}" for i in range(1, table.shape[1] + 1)] if names is None else list(names)
    if len(labels) != table.shape[1]:
        raise ValueError(f"names: {len(labels)} given, must be one for each of the {table.shape[1]} parameters")
    finite = np.isfinite(costs)
    return table[finite], costs[finite], labels
