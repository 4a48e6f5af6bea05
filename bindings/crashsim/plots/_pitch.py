"""Heave and pitch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ._data import MS_PER_S, TIME_LABEL, columns, named, quantity
from ._style import TEST, finish, mark_time, panels, series_style
from ._types import BodyMotion, MeasuredBodyMotion, OneOrMany

if TYPE_CHECKING:
    from ._style import AxesLike


def plot_pitch(
    motion: OneOrMany[BodyMotion],
    *,
    measured: MeasuredBodyMotion | None = None,
    channels: Sequence[str] = ("heave_m", "pitch_rad"),
    axes: AxesLike | None = None,
    end_time_s: float | None = None,
    title: str | None = None,
) -> NDArray[np.object_]:
    """Draws heave [mm] and pitch [deg] of one or several simulations over time [ms], with the measured motion.

    Args:
        motion: response of heave and pitch, coupled or not, several, or a mapping from names for the legend to them.
            One with `t_m_s` has it marked.
        measured: measured motion; a channel without samples is not drawn.
        channels: attributes to draw, one panel each: heave_m, heave_velocity_mps, pitch_rad, pitch_rate_radps.
        axes: as many axes to draw into; None makes a figure.
        end_time_s: where curves end [s]; None: with the last simulated sample.
        title: above the first panel.

    Returns:
        The axes, in the order of `channels`.

    Raises:
        ValueError: lengths differ, a channel is unknown, or the number of axes is not that of channels.
        ImportError: matplotlib is missing.

    Examples:
        >>> import types
        >>> import numpy as np, crashsim
        >>> time_s = np.linspace(0.0, 0.3, 301)
        >>> wave, rate = np.sin(12 * time_s), 12 * np.cos(12 * time_s)
        >>> motion = types.SimpleNamespace(time_s=time_s, heave_m=-0.05 * wave, heave_velocity_mps=-0.05 * rate,
        ...                                pitch_rad=0.06 * wave, pitch_rate_radps=0.06 * rate)
        >>> axes = crashsim.plots.plot_pitch(motion)
    """
    motions = named(motion, "model")
    shown = [quantity(name) for name in channels]
    end_s = max((t[-1] for _, each in motions for t in columns(each, "time_s") if len(t)), default=None)
    end_s = end_s if end_time_s is None else end_time_s
    with panels(axes, len(channels), 0.4 * len(channels) + 0.1) as grid:
        for ax, name, (scale, label) in zip(grid, channels, shown, strict=True):
            if measured is not None and np.size(getattr(measured, name).time_s):
                time, values = columns(getattr(measured, name), "time_s", "values", end_time_s=end_s)
                ax.plot(MS_PER_S * time, scale * values, label="measured", **TEST)
            for index, (who, each) in enumerate(motions):
                time, values = columns(each, "time_s", name, end_time_s=end_s)
                style = series_style(index)
                ax.plot(MS_PER_S * time, scale * values, label=who, **style)
                mark_time(ax, getattr(each, "t_m_s", None), f"$t_m$ of {who}", style["color"])
            ax.set_ylabel(label)
        grid[-1].set_xlabel(TIME_LABEL)
        finish(grid[0], title)
    return grid
