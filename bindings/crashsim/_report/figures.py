"""A figure as a value, and what Plotly takes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .files import Floats
from .markup import plotly_text

MOST_POINTS = 1500
JSON_DIGITS = 6


@dataclass(frozen=True)
class Curve:
    """One curve, in the units of its figure. `color` names a colour of the page's palette."""

    name: str
    x: Floats
    y: Floats
    color: str
    dash: str = "solid"
    mode: str = "lines"
    width: float = 2.0
    symbol: str = "circle"
    stacked: bool = False
    error: Floats | None = None


@dataclass(frozen=True)
class Axis:
    """What an axis shows, and its unit."""

    label: str
    unit: str = ""
    log: bool = False
    integers: bool = False

    @property
    def title(self) -> str:
        """Label with the unit."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label


@dataclass(frozen=True)
class Figure:
    """One picture. `mark_x` is where a vertical line stands, `mark` what it says."""

    key: str
    title: str
    caption: str
    x: Axis
    y: Axis
    curves: list[Curve] = field(default_factory=list)
    mark_x: float | None = None
    mark: str = ""


def kept_points(y: Floats, most: int) -> NDArray[np.intp]:
    """Indices of at most about `most` samples, with the lowest and the highest of every stretch: peaks survive."""
    count = len(y)
    if count <= most:
        return np.arange(count)
    stretches = np.array_split(np.arange(count), max(1, most // 2))
    filled = np.nan_to_num(y)
    extremes = [part[index] for part in stretches for index in (filled[part].argmin(), filled[part].argmax())]
    return np.unique(np.array([0, *extremes, count - 1]))


def numbers(values: Floats) -> list[float | None]:
    """Numbers for JSON: six digits, null for what is not finite."""
    return [float(f"{value:.{JSON_DIGITS}g}") if np.isfinite(value) else None for value in values.tolist()]


def plotly_figure(figure: Figure, most_points: int = MOST_POINTS) -> dict[str, Any]:
    """Traces and layout without colours, which the page fills in from its palette."""
    return {
        "data": [_trace(curve, figure, most_points) for curve in figure.curves],
        "layout": {
            "xaxis": _axis(figure.x),
            "yaxis": _axis(figure.y),
            "showlegend": False,
            "hovermode": "closest",
            "margin": {"l": 62, "r": 16, "t": 24, "b": 46},
            **_mark(figure),
        },
    }


def _axis(axis: Axis) -> dict[str, Any]:
    settings: dict[str, Any] = {"title": {"text": plotly_text(axis.title), "standoff": 8}, "automargin": True}
    if axis.log:
        settings |= {"type": "log", "dtick": "D2", "tickformat": ".2~g"}
    if axis.integers:
        settings |= {"tickformat": ",d", "rangemode": "tozero"}
    return settings


def _mark(figure: Figure) -> dict[str, Any]:
    if figure.mark_x is None:
        return {}
    at = {"xref": "x", "yref": "paper"}
    line = {"type": "line", "x0": figure.mark_x, "x1": figure.mark_x, "y0": 0, "y1": 1, **at, "layer": "below"}
    text = {"x": figure.mark_x, "y": 1, "text": plotly_text(figure.mark), "showarrow": False, "yanchor": "bottom", **at}
    return {"shapes": [line | {"line": {"width": 1, "dash": "dot"}}], "annotations": [text]}


def _trace(curve: Curve, figure: Figure, most_points: int) -> dict[str, Any]:
    kept = np.arange(len(curve.y)) if curve.stacked else kept_points(curve.y, most_points)
    trace: dict[str, Any] = {
        "type": "scatter",
        "name": plotly_text(curve.name),
        "x": numbers(curve.x[kept]),
        "y": numbers(curve.y[kept]),
        "mode": curve.mode,
        "meta": {"color": curve.color},
        "line": {"dash": curve.dash, "width": curve.width},
        "hovertemplate": _hover(curve, figure),
    }
    if "markers" in curve.mode:
        trace["marker"] = {"symbol": curve.symbol, "size": 7, "line": {"width": 1.5}}
    if curve.stacked:
        trace["stackgroup"] = "one"
        trace["line"]["width"] = 1
    if curve.error is not None:
        trace["error_y"] = {"type": "data", "array": numbers(curve.error), "thickness": 1.2, "width": 3}
    return trace


def _hover(curve: Curve, figure: Figure) -> str:
    x, y = figure.x, figure.y
    return f"%{{x:.4~r}} {x.unit}, %{{y:.4~r}} {y.unit}<extra>{plotly_text(curve.name)}</extra>"
