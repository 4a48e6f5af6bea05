"""House style: colours, figures and legends, without a change of matplotlib's settings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ._data import MS_PER_S, known

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap

    AxesLike: TypeAlias = Sequence[Axes] | NDArray[np.object_]

# Okabe and Ito: told apart by colour-blind readers. Line styles and markers tell them apart in grey print.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"
COLORS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (1, 1)), (0, (8, 1.5)))
MARKERS = "os^Dvp*"
LEGEND = {"handlelength": 2.4, "handletextpad": 0.8, "columnspacing": 1.4, "labelspacing": 0.3, "borderpad": 0.2}
TEST: dict[str, Any] = {"color": "0.65", "linewidth": 3.2, "solid_capstyle": "butt"}
MARK: dict[str, Any] = {"color": "0.5", "linewidth": 0.8, "zorder": 1}
NARROW_INCH = 4.5
PANEL_INCH = 1.5


def series_style(index: int) -> dict[str, Any]:
    """Line of the index-th model."""
    return {"color": COLORS[index % len(COLORS)], "linestyle": DASHES[index % len(DASHES)], "linewidth": 1.5}


def series_marker(index: int) -> str:
    """Marker of the index-th model."""
    return MARKERS[index % len(MARKERS)]


def _pyplot() -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install 'crashsim[plots]'") from error
    return plt


def _settings(width_inch: float) -> dict[str, Any]:
    size = 8 if width_inch < NARROW_INCH else 9
    return {
        "font.size": size,
        "axes.labelsize": size,
        "xtick.labelsize": size,
        "ytick.labelsize": size,
        "axes.titlesize": size + 1,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "0.5",
        "grid.alpha": 0.2,
        "grid.linewidth": 0.6,
    }


@contextmanager
def panels(axes: AxesLike | None, count: int, height: float, *, share: bool = True) -> Iterator[NDArray[np.object_]]:
    """The given axes as they are, or `count` new ones below each other in house style, which share their abscissa.

    A new figure is as wide as rcParams["figure.figsize"], and `height` times that high, but high enough for its labels.
    It is closed again when drawing fails.
    """
    if axes is not None:
        given = np.asarray(axes, dtype=object).ravel()
        if len(given) != count:
            raise ValueError(f"axes: {len(given)} given, must be {count}, one for each panel")
        yield given
        return
    plt = _pyplot()
    width_inch = plt.rcParams["figure.figsize"][0]
    with plt.rc_context(_settings(width_inch)):
        size = (width_inch, max(height * width_inch, PANEL_INCH * count + 0.9))
        figure, grid = plt.subplots(count, 1, sharex=share, squeeze=False, figsize=size, layout="constrained")
        for ax in grid.flat:
            _fix_tick_labels(ax)
        figure.align_ylabels()
        try:
            yield grid.ravel()
        except BaseException:
            plt.close(figure)
            raise


def _fix_tick_labels(ax: Axes) -> None:
    """Ticks are made when they are drawn, by the settings of that time, unless told now."""
    ax.tick_params(labelsize=_text_size(ax))


@contextmanager
def panel(ax: Axes | None, height: float = 0.62) -> Iterator[Axes]:
    """The given axes, or new ones, as panels()."""
    with panels(None if ax is None else [ax], 1, height) as axes:
        yield axes[0]


def mark_time(ax: Axes, time_s: float | None, label: str | None = None, color: str = MARK["color"]) -> None:
    """Vertical line at a time; none when it is unset."""
    time = known(time_s)
    if time is not None:
        text = None if label is None else f"{label} = {MS_PER_S * time:.1f} ms"
        ax.axvline(MS_PER_S * time, label=text, linestyle=(0, (4, 2)), **{**MARK, "color": color})


def finish(ax: Axes, title: str | None) -> None:
    """Legend and title above the axes, where they cover no curve."""
    handles, labels = ax.get_legend_handles_labels()
    rows = 0
    if labels:
        entries = _legend_columns(ax, labels)
        rows = math.ceil(len(labels) / entries)
        place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.2, **LEGEND}
        ax.legend(handles, labels, ncols=entries, frameon=False, fontsize=_text_size(ax), **place)
    if title is not None:
        ax.set_title(title, loc="left", pad=6 + 1.45 * rows * _text_size(ax))


def _legend_columns(ax: Axes, labels: Sequence[str]) -> int:
    """As many as fit above the axes."""
    widths, available = _text_widths(ax, labels), _axes_width(ax)
    handle = LEGEND["handlelength"] + LEGEND["handletextpad"]
    for count in range(len(labels), 1, -1):
        texts = sum(max(column) for column in np.array_split(widths, count))
        if texts + _text_size(ax) * (count * handle + (count - 1) * LEGEND["columnspacing"]) <= available:
            return count
    return 1


def set_categories(ax: Axes, labels: Sequence[str]) -> None:
    """Names below places 0, 1, 2, ..., upright where they would run into each other."""
    room = _axes_width(ax) / max(len(labels), 1)
    upright = bool(labels) and max(_text_widths(ax, labels)) > 0.6 * room
    ax.set_xticks(np.arange(len(labels)), labels, rotation=90 if upright else 0)


def _text_size(ax: Axes) -> float:
    return float(ax.xaxis.label.get_fontsize())


def _text_widths(ax: Axes, texts: Sequence[str]) -> list[float]:
    """In points."""
    from matplotlib.textpath import TextPath

    return [float(TextPath((0, 0), text, size=_text_size(ax)).get_extents().width) for text in texts]


def _axes_width(ax: Axes) -> float:
    """In points; where a layout engine is still to place the axes, its share of the figure less room for labels."""
    figure = _figure(ax)
    width = 72 * figure.bbox.width / figure.dpi * ax.get_position().width
    if figure.get_layout_engine() is None:
        return float(width)
    margins = figure.subplotpars.right - figure.subplotpars.left
    return float(width / margins - 8 * _text_size(ax))


def _figure(ax: Axes) -> Any:
    return ax.get_figure(root=False)


def label_log_axis(ax: Axes) -> None:
    """Plain numbers on a logarithmic vertical axis, also within a decade."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_locator(NullLocator())


def sequential_map() -> Colormap:
    """Viridis without its yellow end, which is hard to see on white."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    return ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.85, 256)), name="crashsim")


def add_colorbar(
    ax: Axes, mappable: Any, label: str, *, ticks: Sequence[float] | None = None, log: bool = False
) -> None:
    """Colour bar beside the axes, part of them."""
    cax = ax.inset_axes((1.03, 0.0, 0.03, 1.0))
    bar = _figure(ax).colorbar(mappable, cax=cax, label=label)
    bar.outline.set_visible(False)
    cax.tick_params(labelsize=_text_size(ax))
    cax.yaxis.label.set_fontsize(_text_size(ax))
    if log:
        label_log_axis(cax)
    if ticks is not None:
        bar.set_ticks(list(ticks), labels=[f"{tick:.3g}" for tick in ticks])
        bar.minorticks_off()
