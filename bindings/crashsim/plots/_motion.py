"""Pulse, fit and prediction: crush over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._data import MS_PER_S, TIME_LABEL, Quantity, SpeedUnit, columns, known, named, quantity
from ._style import MARK, TEST, add_colorbar, finish, mark_time, panel, panels, sequential_map, series_style
from ._types import Motion, OneOrMany, SpeedMotion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._style import AxesLike

CHANNELS = ("accel_mps2", "velocity_mps", "displacement_m")
BEYOND_T_M = 1.25
MAX_SPEED_INTERVALS = 10


def plot_pulse(
    pulse: OneOrMany[Motion],
    *,
    axes: AxesLike | None = None,
    speed_unit: SpeedUnit = "km/h",
    end_time_s: float | None = None,
    title: str | None = None,
) -> NDArray[np.object_]:
    """Draws acceleration [g], velocity and crush [mm] of one or several motions over time [ms], with t_m.

    Args:
        pulse: motion, several, or a mapping from names for the legend to motions.
        axes: three axes to draw into; None makes a figure.
        speed_unit: "km/h" or "m/s".
        end_time_s: where curves end [s]; None shows all samples.
        title: above the first panel.

    Returns:
        The three axes: acceleration, velocity, crush.

    Raises:
        ValueError: lengths differ, or not three axes are given.
        ImportError: matplotlib is missing.

    Examples:
        >>> import numpy as np, crashsim
        >>> time_s = np.linspace(0.0, 0.12, 1201)
        >>> accel_mps2 = -300.0 * np.sin(np.pi * np.minimum(time_s / 0.09, 1.0))
        >>> pulse = crashsim.make_pulse(time_s, accel_mps2, impact_speed_mps=15.6, mass_kg=1190.0)
        >>> axes = crashsim.plots.plot_pulse(pulse)
    """
    pulses = named(pulse, "pulse")
    with panels(axes, len(CHANNELS), 0.95) as grid:
        for index, (label, motion) in enumerate(pulses):
            style = series_style(index)
            _draw_motion(grid, motion, label, style, speed_unit, end_time_s)
            for ax in grid:
                mark_time(ax, motion.t_m_s, "$t_m$" if len(pulses) == 1 else f"$t_m$ of {label}", style["color"])
        finish(grid[0], title)
    return grid


def plot_response(
    response: OneOrMany[Motion],
    *,
    against: Motion | None = None,
    axes: AxesLike | None = None,
    speed_unit: SpeedUnit = "km/h",
    end_time_s: float | None = None,
    title: str | None = None,
) -> NDArray[np.object_]:
    """Draws a simulated motion as plot_pulse() does, or over a test as plot_fit() does.

    Args:
        response: response, several, or a mapping from names for the legend to responses.
        against: the measured motion; None: none.
        axes: three axes to draw into; None makes a figure.
        speed_unit: "km/h" or "m/s".
        end_time_s: where curves end [s].
        title: above the first panel.

    Returns:
        The three axes: acceleration, velocity, crush.

    Raises:
        ValueError: lengths differ, or not three axes are given.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0], [5e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper, impact_speed_mps=13.9)
        >>> axes = crashsim.plots.plot_response(crashsim.simulate(model))
    """
    if against is not None:
        return plot_fit(against, response, axes=axes, speed_unit=speed_unit, end_time_s=end_time_s, title=title)
    models = dict(named(response, "model"))
    return plot_pulse(models, axes=axes, speed_unit=speed_unit, end_time_s=end_time_s, title=title)


def plot_fit(
    test: Motion,
    model: OneOrMany[Motion],
    *,
    axes: AxesLike | None = None,
    speed_unit: SpeedUnit = "km/h",
    end_time_s: float | None = None,
    title: str | None = None,
) -> NDArray[np.object_]:
    """Draws one or several models over the test: acceleration [g], velocity and crush [mm] over time [ms], with t_m.

    Args:
        test: the measured motion, thick and grey.
        model: response, several, or a mapping from names for the legend to responses.
        axes: three axes to draw into; None makes a figure.
        speed_unit: "km/h" or "m/s".
        end_time_s: where curves end [s]; None: at 1.25 t_m of the test, or all samples when it has none.
        title: above the first panel.

    Returns:
        The three axes: acceleration, velocity, crush.

    Raises:
        ValueError: lengths differ, or not three axes are given.
        ImportError: matplotlib is missing.

    Examples:
        >>> import numpy as np, crashsim
        >>> time_s = np.linspace(0.0, 0.12, 1201)
        >>> accel_mps2 = -300.0 * np.sin(np.pi * np.minimum(time_s / 0.09, 1.0))
        >>> pulse = crashsim.make_pulse(time_s, accel_mps2, impact_speed_mps=15.6, mass_kg=1190.0)
        >>> fit = crashsim.identify(pulse, starts=4)
        >>> axes = crashsim.plots.plot_fit(pulse, crashsim.simulate(fit.model))
    """
    t_m_s = known(test.t_m_s)
    end_s = BEYOND_T_M * t_m_s if end_time_s is None and t_m_s is not None else end_time_s
    with panels(axes, len(CHANNELS), 0.95) as grid:
        _draw_motion(grid, test, "test", TEST, speed_unit, end_s)
        for index, (label, motion) in enumerate(named(model, "model")):
            _draw_motion(grid, motion, label, series_style(index), speed_unit, end_s)
        for ax in grid:
            mark_time(ax, t_m_s, "$t_m$")
        finish(grid[0], title)
    return grid


def _draw_motion(
    grid: NDArray[np.object_], motion: Motion, label: str, style: dict[str, Any], unit: SpeedUnit, end_s: float | None
) -> None:
    time, *channels = columns(motion, "time_s", *CHANNELS, end_time_s=end_s)
    for ax, name, values in zip(grid, CHANNELS, channels, strict=True):
        shown = quantity(name, unit)
        ax.plot(MS_PER_S * time, shown.scale * values, label=label, **style)
        ax.set_ylabel(shown.label)
    grid[-1].set_xlabel(TIME_LABEL)


def plot_prediction(
    responses: Sequence[SpeedMotion],
    *,
    channel: Literal["accel_mps2", "velocity_mps", "displacement_m"] = "accel_mps2",
    ax: Axes | None = None,
    speed_unit: SpeedUnit = "km/h",
    end_time_s: float | None = None,
    title: str | None = None,
) -> Axes:
    """Draws one channel of a model's motions from several speeds over time [ms], coloured by speed, a dot at each t_m.

    Args:
        responses: motions with their `impact_speed_mps`, in any order.
        channel: attribute to draw.
        ax: axes to draw into; None makes a figure. The colour bar is inside their right margin.
        speed_unit: "km/h" or "m/s".
        end_time_s: where curves end [s]; None shows all samples.
        title: above the axes.

    Returns:
        The axes.

    Raises:
        ValueError: lengths differ, no response is given or one does not know its speed.
        ImportError: matplotlib is missing.

    Examples:
        >>> import crashsim
        >>> spring = crashsim.PiecewiseLinear([0.0, 0.3, 0.6], [800e3, 500e3, 600e3])
        >>> damper = crashsim.PiecewiseLinear([0.0], [5e3])
        >>> model = crashsim.CrushModel(1190.0, spring=spring, damper=damper)
        >>> responses = [crashsim.simulate(model, impact_speed_mps=speed / 3.6) for speed in range(30, 61, 5)]
        >>> ax = crashsim.plots.plot_prediction(responses)
    """
    shown, scale = quantity(channel, speed_unit), 1.0 if speed_unit == "m/s" else 3.6
    ordered = sorted(((_speed(motion, i), motion) for i, motion in enumerate(responses)), key=lambda pair: pair[0])
    if not ordered:
        raise ValueError("responses: none given, need at least one")
    speeds = [scale * speed for speed, _ in ordered]
    with panel(ax) as ax:
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        spread = max(speeds[-1] - speeds[0], 1e-9 * speeds[-1])
        colors = ScalarMappable(Normalize(speeds[0], speeds[0] + spread), sequential_map())
        for color, (_, motion) in zip(colors.to_rgba(np.array(speeds)), ordered, strict=True):
            _draw_predicted(ax, motion, channel, shown, color, end_time_s)
        if any(known(motion.t_m_s) is not None for _, motion in ordered):
            ax.plot([], [], "o", color=MARK["color"], markersize=4, label="$t_m$")
        ax.set(xlabel=TIME_LABEL, ylabel=shown.label)
        add_colorbar(ax, colors, f"impact speed [{speed_unit}]", ticks=_ticks(speeds))
        finish(ax, title)
    return ax


def _ticks(speeds: list[float]) -> list[float] | None:
    """The speeds themselves, unless their labels would run into each other."""
    distinct = np.unique(speeds)
    room = (distinct[-1] - distinct[0]) / MAX_SPEED_INTERVALS
    return distinct.tolist() if np.all(np.diff(distinct) >= room) else None


def _draw_predicted(
    ax: Axes, motion: Motion, channel: str, shown: Quantity, color: Any, end_time_s: float | None
) -> None:
    time, values = columns(motion, "time_s", channel, end_time_s=end_time_s)
    ax.plot(MS_PER_S * time, shown.scale * values, color=color, linewidth=1.5)
    t_m_s = known(motion.t_m_s)
    if t_m_s is not None and len(time) and t_m_s <= time[-1]:
        ax.plot(MS_PER_S * t_m_s, shown.scale * np.interp(t_m_s, time, values), "o", color=color, markersize=4)


def _speed(motion: SpeedMotion, index: int) -> float:
    speed = known(motion.impact_speed_mps)
    if speed is None:
        raise ValueError(f"responses[{index}].impact_speed_mps: unset, must be known to colour the curve by it")
    return speed
