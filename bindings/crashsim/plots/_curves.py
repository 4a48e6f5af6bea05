"""Spring and damper of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._data import CRUSH_LABEL, MM_PER_M, Floats, named, option_name, same_length, vector
from ._style import finish, panel, panels, series_marker, series_style
from ._types import Curve, Fit, Model, ModelOrFit, OneOrMany

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._style import AxesLike

KILO = 1e-3
SPRING_LABELS = {"stiffness": "stiffness k [kN/m]", "force": "spring force f [kN]"}


def plot_spring(
    model: OneOrMany[ModelOrFit],
    *,
    standard_error: ArrayLike | None = None,
    ax: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the spring of one or several models over crush [mm], knots marked: stiffness [kN/m], or force [kN] by law.

    Args:
        model: model or identification, several, or a mapping from names for the legend to them. An identification
            brings its standard errors, drawn as a band of one on either side.
        standard_error: of the ordinates of a single model [N/m or N], NaN where unknown.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, models of both laws, or standard errors for several models.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0, 15.0], [9e3, 2e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper)
        >>> ax = crashsim.plots.plot_spring(model, standard_error=[40e3, 20e3, 10e3])
    """
    things: list[tuple[str, ModelOrFit]] = named(model, "spring")
    laws = {option_name(_model(thing).law) for _, thing in things}
    if len(laws) != 1 or not laws <= set(SPRING_LABELS):
        raise ValueError(f"law = {', '.join(sorted(laws))}: must be one for all models, 'stiffness' or 'force'")
    with panel(ax) as ax:
        for index, (label, thing) in enumerate(things):
            errors = _standard_error(thing, standard_error, len(things), of_spring=True)
            _draw_curve(ax, _model(thing).spring, MM_PER_M, errors, index, label)
        ax.set(xlabel=CRUSH_LABEL, ylabel=SPRING_LABELS[laws.pop()])
        finish(ax, title)
    return ax


def plot_damper(
    model: OneOrMany[ModelOrFit],
    *,
    standard_error: ArrayLike | None = None,
    ax: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the damper of one or several models: damping [kN s/m] over velocity [m/s], knots marked.

    Args:
        model: model or identification, several, or a mapping from names for the legend to them. An identification
            brings its standard errors, drawn as a band of one on either side.
        standard_error: of the ordinates of a single model [N s/m], NaN where unknown.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, or standard errors for several models.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0, 15.0], [9e3, 2e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper)
        >>> ax = crashsim.plots.plot_damper(model)
    """
    things: list[tuple[str, ModelOrFit]] = named(model, "damper")
    with panel(ax) as ax:
        for index, (label, thing) in enumerate(things):
            errors = _standard_error(thing, standard_error, len(things), of_spring=False)
            _draw_curve(ax, _model(thing).damper, 1.0, errors, index, label)
        ax.set(xlabel="velocity [m/s]", ylabel="damping c [kN s/m]")
        finish(ax, title)
    return ax


def plot_model(
    model: OneOrMany[ModelOrFit], *, axes: AxesLike | None = None, title: str | None = None
) -> NDArray[np.object_]:
    """Draws spring and damper of one or several models, as plot_spring() and plot_damper().

    Args:
        model: model or identification, several, or a mapping from names for the legend to them.
        axes: two axes to draw into; None makes a figure.
        title: above the first panel.

    Returns:
        The two axes: spring, damper.

    Raises:
        ValueError: lengths differ, models of both laws, or not two axes are given.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0, 15.0], [9e3, 2e3])
        >>> axes = crashsim.plots.plot_model(crashsim.CrushModel(1190.0, spring=spring, damper=damper))
    """
    with panels(axes, 2, 0.95, share=False) as grid:
        plot_spring(model, ax=grid[0], title=title)
        plot_damper(model, ax=grid[1])
    return grid


def _model(thing: ModelOrFit) -> Model:
    return cast(Model, getattr(thing, "model", thing))


def _standard_error(thing: ModelOrFit, given: ArrayLike | None, models: int, *, of_spring: bool) -> Floats | None:
    if given is not None:
        if models != 1:
            raise ValueError(
                f"standard_error: given for {models} models, must be for one; pass identifications instead"
            )
        return vector(given, "standard_error")
    if not hasattr(thing, "ordinates"):
        return None
    part = "spring" if of_spring else "damper"
    errors = [ordinate.standard_error for ordinate in cast(Fit, thing).ordinates if ordinate.part == part]
    curve = _model(thing).spring if of_spring else _model(thing).damper
    if len(errors) != len(np.asarray(curve.knots)):
        return None  # a curve that is a table has more knots than were fitted
    return np.array(errors, dtype=np.float64)


def _draw_curve(ax: Axes, curve: Curve, scale: float, errors: Floats | None, index: int, label: str) -> None:
    knots, ordinates = same_length(knots=curve.knots, ordinates=curve.ordinates)
    style = series_style(index)
    if len(knots) == 1:
        ax.axhline(KILO * ordinates[0], **style)
    ax.plot(scale * knots, KILO * ordinates, marker=series_marker(index), markersize=5, label=label, **style)
    if errors is not None:
        _, band = same_length(ordinates=ordinates, standard_error=errors)
        low, high = np.maximum(ordinates - band, 0.0), ordinates + band
        name = "standard error" if index == 0 else None
        ax.fill_between(
            scale * knots, KILO * low, KILO * high, color=style["color"], alpha=0.2, linewidth=0, label=name
        )
