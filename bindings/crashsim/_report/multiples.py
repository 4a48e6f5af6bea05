"""Small multiples: one small drawing for every case, all with the same axes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .figures import Axis, kept_points
from .files import Floats
from .markup import Content, Markup, tag

WIDTH, HEIGHT = 200, 110
MOST_POINTS = 100


@dataclass(frozen=True)
class Panel:
    """One case: its name, a note where it has no good result, and x and y of test and model in display units."""

    head: Content
    note: str
    test: tuple[Floats, Floats] | None
    model: tuple[Floats, Floats] | None


@dataclass(frozen=True)
class Frame:
    """Common axes of the drawings."""

    x_low: float
    x_high: float
    y_low: float
    y_high: float

    def place(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Display units to the drawing's coordinates."""
        across = WIDTH * (x - self.x_low) / (self.x_high - self.x_low)
        return across, HEIGHT * (self.y_high - y) / (self.y_high - self.y_low)


def multiples(kinds: Mapping[str, tuple[Axis, Axis, Sequence[Panel]]]) -> Markup:
    """Small multiples of several kinds, one shown at a time; without scripts and in print the choice stands."""
    inputs, groups = [], []
    for index, (title, (x, y, panels)) in enumerate(kinds.items()):
        key = f"kind-{index + 1}"
        checked = index == 0
        inputs.append(tag("input", type="radio", name="kind", id=key, checked=checked))
        inputs.append(tag("label", title, for_=key))
        groups.append(_group(f"multiples {key}", x, y, panels))
    return tag("div", inputs, groups, class_="kinds")


def _group(class_: str, x: Axis, y: Axis, panels: Sequence[Panel]) -> Markup:
    frame = _frame(panels)
    text = (
        f"{x.label.capitalize()} from {_round(frame.x_low)} to {_round(frame.x_high)} {x.unit}, "
        f"{y.label} from {_round(frame.y_low)} to {_round(frame.y_high)} {y.unit} in every drawing."
    )
    key = [tag("span", "test", class_="color-test"), tag("span", "model", class_="color-model")]
    drawings = [tag("li", _panel(panel, frame), data_case=index) for index, panel in enumerate(panels)]
    return tag("div", tag("p", text, " ", key, class_="key"), tag("ul", drawings), class_=class_)


def _panel(panel: Panel, frame: Frame) -> Markup:
    _, zero = frame.place(np.zeros(1), np.zeros(1))
    lines = [tag("path", d=f"M0 {zero[0]:.1f}H{WIDTH}", class_="zero")]
    lines += [_line(*panel.test, frame, "color-test")] if panel.test else []
    lines += [_line(*panel.model, frame, "color-model")] if panel.model else []
    drawing = tag("svg", lines, viewBox=f"0 0 {WIDTH} {HEIGHT}", aria_hidden="true", preserveAspectRatio="none")
    note = tag("p", panel.note, class_="note") if panel.note else None
    return tag("figure", tag("figcaption", panel.head), drawing, note)


def _line(x: Floats, y: Floats, frame: Frame, class_: str) -> Markup:
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[finite], y[finite]
    kept = kept_points(y, MOST_POINTS)
    across, down = frame.place(x[kept], y[kept])
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across.tolist(), down.tolist(), strict=True))
    return tag("polyline", points=points, class_=class_)


def _frame(panels: Sequence[Panel]) -> Frame:
    curves = [curve for panel in panels for curve in (panel.test, panel.model) if curve is not None]
    x_low, x_high = _range(x for x, _ in curves)
    y_low, y_high = _range(y for _, y in curves)
    return Frame(x_low, x_high, y_low, y_high)


def _range(values: Iterator[Floats]) -> tuple[float, float]:
    """From the lowest to the highest, with 0, and never empty."""
    low, high = 0.0, 0.0
    for array in values:
        finite = array[np.isfinite(array)]
        low, high = min(low, float(finite.min(initial=0.0))), max(high, float(finite.max(initial=0.0)))
    return (low, high) if high > low else (low, low + 1.0)


def _round(value: float) -> str:
    return f"{value:.3g}".replace("-", "\u2212") if math.isfinite(value) else ""
