"""What people see of results: repr, tables in notebooks, data frames and plots.

The engine's classes have their fields in ``_fields``; everything here follows from that list.
"""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import types

_MOST_ITEMS = 4
_PLOTS = {
    "Pulse": "plot_pulse",
    "CrushResponse": "plot_response",
    "CrushModel": "plot_model",
    "Identification": "plot_model",
    "PitchResponse": "plot_pitch",
    "CoupledResponse": "plot_pitch",
}


def adorn(core: types.ModuleType) -> None:
    """Gives every class with fields its repr, and its table where it has curves."""
    for item in vars(core).values():
        if isinstance(item, type) and hasattr(item, "_fields"):
            item.__repr__ = _repr  # type: ignore[assignment,method-assign]
            item._repr_html_ = _repr_html  # type: ignore[attr-defined]
            item.to_dataframe = _to_dataframe  # type: ignore[attr-defined]
            if item.__name__ in _PLOTS:
                item.plot = _plot  # type: ignore[attr-defined]


def _is_unset(value: object) -> bool:
    if isinstance(value, np.ndarray):
        return value.size == 0
    return value is None or value == "" or value == () or (isinstance(value, float) and math.isnan(value))


def _brief(value: object) -> str:
    if isinstance(value, np.ndarray):
        if value.size <= _MOST_ITEMS and value.ndim == 1 and value.dtype.kind == "U":
            return "[" + ", ".join(value) + "]"
        if value.size <= _MOST_ITEMS and value.ndim == 1:
            return "[" + ", ".join(f"{x:.6g}" for x in value) + "]"
        return f"array of {' x '.join(map(str, value.shape))}"
    if isinstance(value, tuple) and len(value) > _MOST_ITEMS:
        return f"({value[0]!r}, .., {len(value)} in all)"
    return f"{value:.6g}" if isinstance(value, float) else repr(value)


def _repr(self: Any) -> str:
    shown = [(name, getattr(self, name)) for name in self._fields]
    inside = ", ".join(f"{name}={_brief(value)}" for name, value in shown if not _is_unset(value))
    return f"{type(self).__name__}({inside})"


def _repr_html(self: Any) -> str:
    rows = []
    for name in self._fields:
        value = getattr(self, name)
        if _is_unset(value):
            continue
        doc = getattr(type(self), name).__doc__ or ""
        cells = "".join(f"<td style='text-align:left'>{html.escape(text)}</td>" for text in (name, _brief(value), doc))
        rows.append(f"<tr>{cells}</tr>")
    return f"<table><caption>{type(self).__name__}</caption><tbody>{''.join(rows)}</tbody></table>"


def columns_of(result: Any) -> dict[str, np.ndarray]:
    """The one-dimensional arrays of a result that are as long as its first one; a row a model where it has many."""
    columns: dict[str, np.ndarray] = {}
    for name in getattr(result, "_columns", result._fields):
        value = getattr(result, name)
        if isinstance(value, np.ndarray) and value.ndim == 1:
            if columns and value.shape != next(iter(columns.values())).shape:
                continue
            columns[name] = value
    return columns


def _to_dataframe(self: Any) -> Any:
    """The curves as a pandas DataFrame, a column each; a list of reports has a row each.

    Raises ImportError when pandas is not installed, TypeError when there are no curves.
    """
    try:
        import pandas
    except ImportError as error:
        raise ImportError("to_dataframe() needs pandas: pip install pandas") from error
    columns: dict[str, Any] = self._table() if hasattr(self, "_table") else dict(columns_of(self))
    if not columns and hasattr(self, "ordinates"):
        columns = {name: [getattr(row, name) for row in self.ordinates] for name in _ordinate_fields(self)}
    if not columns:
        raise TypeError(f"{type(self).__name__} has no curves for a table")
    return pandas.DataFrame(columns)


def _ordinate_fields(result: Any) -> tuple[str, ...]:
    return tuple(result.ordinates[0]._fields) if result.ordinates else ("name", "value", "standard_error")


def _plot(self: Any, **options: Any) -> Any:
    """Draws the result with matplotlib: see crashsim.plots. Returns its axes."""
    from . import plots

    return getattr(plots, _PLOTS[type(self).__name__])(self, **options)
