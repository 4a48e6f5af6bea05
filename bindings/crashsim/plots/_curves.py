"""Spring and damper of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._data import CRUSH_LABEL, MM_PER_M, Floats, named, option_name, same_length, vector
from ._style import finish, panel, panels, series_marker, series_style
from ._types import Curve, Fit, Model, ModelOrFit, OneOrMany, RateModel

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._style import AxesLike

T = TypeVar("T")

KILO = 1e-3
FORCE_LABEL = "spring force f [kN]"
SPRING_LABELS = {"stiffness": "stiffness k [kN/m]", **dict.fromkeys(("force", "crush_damping", "rate"), FORCE_LABEL)}
SPEED_AXES = ("velocity [m/s]", "damping c [kN s/m]")
DAMPER_AXES = {
    "stiffness": SPEED_AXES,
    "force": SPEED_AXES,
    "crush_damping": (CRUSH_LABEL, SPEED_AXES[1]),
    "rate": (SPEED_AXES[0], "rate factor 1 + r ln(1 + |v|/v_ref)"),
}
FASTEST_MPS = 20.0  # to which a rate is drawn when the impact speed is not known


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
        ValueError: lengths differ, stiffnesses beside forces, or standard errors for several models.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0, 15.0], [9e3, 2e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper)
        >>> ax = crashsim.plots.plot_spring(model, standard_error=[40e3, 20e3, 10e3])
    """
    things: list[tuple[str, ModelOrFit]] = named(model, "spring")
    y_label = _shared(SPRING_LABELS, things)
    with panel(ax) as ax:
        for index, (label, thing) in enumerate(things):
            errors = _standard_error(thing, standard_error, len(things), of_spring=True)
            _draw_curve(ax, _model(thing).spring, MM_PER_M, errors, index, label)
        ax.set(xlabel=CRUSH_LABEL, ylabel=y_label)
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

    With law "crush_damping" it is over crush [mm]; with law "rate" the factor of the spring's force over velocity is
    drawn instead.

    Args:
        model: model or identification, several, or a mapping from names for the legend to them. An identification
            brings its standard errors, drawn as a band of one on either side.
        standard_error: of the ordinates of a single model [N s/m], of law "rate" of its coefficient; NaN where unknown.
        ax: axes to draw into; None makes a figure.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, laws whose dampers are over different things, or standard errors for several models.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0, 15.0], [9e3, 2e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper)
        >>> ax = crashsim.plots.plot_damper(model)
    """
    things: list[tuple[str, ModelOrFit]] = named(model, "damper")
    x_label, y_label = _shared(DAMPER_AXES, things)
    scale = MM_PER_M if x_label == CRUSH_LABEL else 1.0
    with panel(ax) as ax:
        for index, (label, thing) in enumerate(things):
            errors = _standard_error(thing, standard_error, len(things), of_spring=False)
            if option_name(_model(thing).law) == "rate":
                _draw_rate(ax, cast(RateModel, _model(thing)), errors, index, label)
            else:
                _draw_curve(ax, _model(thing).damper, scale, errors, index, label)
        ax.set(xlabel=x_label, ylabel=y_label)
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
        ValueError: lengths differ, models whose laws have different axes, or not two axes are given.
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


def _shared(axes: dict[str, T], things: list[tuple[str, ModelOrFit]]) -> T:
    """What the laws of all things have in common."""
    laws = sorted({option_name(_model(thing).law) for _, thing in things})
    found = {axes[law] for law in laws if law in axes}
    if len(found) != 1 or not set(laws) <= set(axes):
        raise ValueError(
            f"law = {', '.join(laws)}: must be one for all models, of {', '.join(axes)}, or such as have the same axes"
        )
    return found.pop()


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
    model = _model(thing)
    part, expected = "spring", len(np.asarray(model.spring.knots))
    if not of_spring:
        is_rate = option_name(model.law) == "rate"
        part, expected = ("rate", 1) if is_rate else ("damper", len(np.asarray(model.damper.knots)))
    errors = [number.standard_error for number in cast(Fit, thing).ordinates if option_name(number.part) == part]
    if len(errors) != expected:
        return None  # a curve that is a table has more knots than were fitted
    return np.array(errors, dtype=np.float64)


def _draw_rate(ax: Axes, model: RateModel, errors: Floats | None, index: int, label: str) -> None:
    end = float(model.impact_speed_mps)
    speed = np.linspace(0.0, end if end > 0 else FASTEST_MPS, 200)
    log = np.log1p(speed / float(model.reference_speed_mps))
    r, style = float(model.rate_coefficient), series_style(index)
    ax.plot(speed, 1.0 + r * log, label=label, **style)
    if errors is not None and len(errors) == 1 and np.isfinite(errors[0]):
        low, high = (1.0 + max(r + side * errors[0], 0.0) * log for side in (-1.0, 1.0))
        name = "standard error" if index == 0 else None
        ax.fill_between(speed, low, high, color=style["color"], alpha=0.2, linewidth=0, label=name)


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
