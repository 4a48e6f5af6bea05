"""The tables of one case."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .case import CaseDirectory, Model, Ordinates, Rate
from .files import Node
from .markup import Content, Markup, tag
from .quantities import (
    KILONEWTON,
    KILONEWTON_PER_METRE,
    KILONEWTON_SECOND_PER_METRE,
    METRE_PER_SECOND,
    MILLIMETRE,
    MISSING,
    Unit,
    outcome_words,
    shown,
    shown_number,
    speed_name,
    unit_of,
    words,
)

GRADES = ("poor", "fair", "good", "excellent")
COMPARISONS = {
    "to_max_crush": "Up to maximum crush",
    "whole_record": "Whole record",
    "heave_and_pitch": "Heave and pitch after the crush",
    "heave_and_pitch_coupled": "Heave and pitch, coupled",
}
SCORES = {
    "corridor": "corridor Z",
    "phase": "phase EP",
    "magnitude": "magnitude EM",
    "slope": "slope ES",
}
PREDICTED = ("max_crush_m", "t_m_s", "peak_decel_g", "mean_decel_g", "olc_g", "vpi_g", "energy_j")


def table(caption: str, head: list[Content], rows: list[Content], class_: str = "") -> Markup:
    """A table that scrolls by itself when the screen is narrow."""
    body = tag(
        "table",
        tag("caption", caption),
        tag("thead", tag("tr", [tag("th", cell, scope="col") for cell in head])),
        tag("tbody", rows),
        class_=class_ or None,
    )
    return tag("div", body, class_="scroll", role="region", aria_label=caption, tabindex="0")


def row(name: Content, *cells: Content) -> Markup:
    """A line of a table: what it is about, then numbers."""
    return tag("tr", tag("th", name, scope="row"), [tag("td", cell) for cell in cells])


def grade_badge(grade: str) -> Markup:
    """A grade in colour, with dots and with its word."""
    known = grade if grade in GRADES else "unrated"
    dots = GRADES.index(grade) + 1 if grade in GRADES else 0
    marks = "\u25cf" * dots + "\u25cb" * (len(GRADES) - dots)
    return tag("span", tag("span", marks, aria_hidden="true"), " ", grade or known, class_=f"badge {known}")


def summary_table(case: CaseDirectory) -> Markup | None:
    """The numbers of test and model side by side, and how much they differ."""
    test, model = case.part("pulse"), case.summary
    names = [name for name in (model.values if model else {}) if _is_number(model, name)]
    if model is None or not names:
        return None
    if test is None:
        rows = [row(words(name), shown(name, model.number(name))) for name in names]
        return table("Numbers of the model", ["quantity", "model"], [*rows])
    rows = [row(words(name), *_both(name, test.number(name), model.number(name))) for name in names]
    return table("Numbers of test and model", ["quantity", "test", "model", "difference"], [*rows])


def _is_number(node: Node | None, name: str) -> bool:
    value = node.values.get(name, "") if node else ""
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def _both(name: str, test: float | None, model: float | None) -> tuple[str, str, str]:
    return shown(name, test), shown(name, model), _difference(test, model)


def _difference(test: float | None, model: float | None) -> str:
    if test is None or model is None or test == 0:
        return MISSING
    percent = 100 * (model - test) / abs(test)
    return "0 %" if abs(percent) < 0.005 else f"{percent:+.2f} %".replace("-", "\u2212")


def coupled_table(case: CaseDirectory) -> Markup | None:
    """The numbers of the coupled simulation."""
    part = case.part("coupled")
    if part is None:
        return None
    rows = [row(words(name), shown(name, part.number(name))) for name in part.values if _is_number(part, name)]
    return table("Numbers of the coupled simulation", ["quantity", "value"], [*rows])


def prediction_table(case: CaseDirectory) -> Markup | None:
    """One line for every speed."""
    parts = {name: case.part(f"prediction_{name}") for name in case.predictions}
    rows = [
        row(speed_name(name), *(shown(key, part.number(key)) for key in PREDICTED), outcome_words(part.text("outcome")))
        for name, part in parts.items()
        if part is not None
    ]
    head: list[Content] = ["speed", *(words(key) for key in PREDICTED), "outcome"]
    return table("Predictions", head, [*rows]) if rows else None


def rating_tables(case: CaseDirectory) -> list[Markup]:
    """ISO/TS 18571 ratings with their scores, and plain errors, one table for every comparison."""
    return [_rating_table(name, comparison) for name, comparison in case.comparisons.items()]


def comparison_words(name: str) -> str:
    """What a comparison is called."""
    return COMPARISONS.get(name, name.replace("_", " ").capitalize())


def _rating_table(name: str, comparison: Node) -> Markup:
    window = f"{shown('start_s', comparison.number('start_s'))} to {shown('end_s', comparison.number('end_s'))}"
    head: list[Content] = ["channel", "grade", "rating R", *SCORES.values(), "mean error", "largest error", "relative"]
    rows = [_rating_row(channel) for channel in comparison.nodes("channels")]
    notes = [tag("li", note) for note in comparison.texts("notes")]
    return tag(
        "div",
        table(f"{comparison_words(name)}, {window}", head, [*rows], class_="ratings"),
        tag("ul", notes, class_="notes") if notes else None,
    )


def _rating_row(channel: Node) -> Markup:
    name = channel.text("name")
    rating = channel.node("iso18571") or Node(channel.path, {})
    errors = channel.node("errors") or Node(channel.path, {})
    relative = errors.number("mean_abs_relative")
    reason = rating.text("not_rated")
    return row(
        words(name),
        [grade_badge(rating.text("grade")), tag("p", reason, class_="reason") if reason else None],
        _score(rating.number("overall")),
        *(_score(rating.number(score)) for score in SCORES),
        shown(name, errors.number("mean_abs")),
        shown(name, errors.number("max_abs")),
        MISSING if relative is None else f"{100 * relative:.2f} %",
    )


def _score(value: float | None) -> Markup:
    if value is None:
        return tag("span", MISSING)
    return tag("span", f"{value:.3f}", class_="score", style=f"--score:{min(1.0, max(0.0, value)):.3f}")


def parameter_table(model: Model) -> Markup:
    """Knots and ordinates of spring and damper."""
    fit = model.identification
    marks = dict.fromkeys(fit.texts("at_bound"), "at its bound") if fit else {}
    marks |= dict.fromkeys(fit.texts("untouched"), "no sample depends on it") if fit else {}
    stiffness = KILONEWTON_PER_METRE if model.law == "stiffness" else KILONEWTON
    damper_knots = MILLIMETRE if model.law == "crush_damping" else METRE_PER_SECOND
    rows: list[Markup] = []
    if model.spring:
        rows += _parameter_rows(model.spring, "k", MILLIMETRE, stiffness, marks)
    if model.damper:
        rows += _parameter_rows(model.damper, "c", damper_knots, KILONEWTON_SECOND_PER_METRE, marks)
    if model.rate:
        rows.append(_rate_row(model.rate, marks))
    head: list[Content] = ["ordinate", "knot", "value", "standard error", "remark"]
    return table("Spring and damper", head, [*rows])


def _rate_row(rate: Rate, marks: dict[str, str]) -> Markup:
    return row(
        "r",
        f"v_ref {shown_number(rate.reference_speed_mps)} m/s",
        shown_number(rate.coefficient),
        MISSING if rate.standard_error is None else shown_number(rate.standard_error, 3),
        marks.get("r", ""),
    )


def _parameter_rows(
    curve: Ordinates, letter: str, x_unit: Unit, y_unit: Unit, marks: dict[str, str]
) -> Iterator[Markup]:
    for index, (knot, value) in enumerate(zip(curve.knots.tolist(), curve.values.tolist(), strict=True)):
        error = math.nan if curve.standard_error is None else float(curve.standard_error[index])
        name = f"{letter}{index + 1}"
        yield row(
            name,
            f"{shown_number(x_unit.scale * knot)} {x_unit.symbol}",
            f"{shown_number(y_unit.scale * value)} {y_unit.symbol}",
            f"{shown_number(y_unit.scale * error, 3)} {y_unit.symbol}" if math.isfinite(error) else MISSING,
            marks.get(name, ""),
        )


def identification_table(case: CaseDirectory) -> Markup | None:
    """Errors, starts and what the data determine."""
    part = case.part("identification")
    if part is None:
        return None
    rows = [
        row(words(name), _plain(value)) for name, value in part.values.items() if name not in ("verdict", "outcome")
    ]
    return table("Identification", ["quantity", "value"], [*rows])


def _plain(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return str(value)
    return shown_number(value) if isinstance(value, float) else str(value)


def record_tables(record: Node) -> list[Markup]:
    """What made the results: command, version, inputs with their hashes, options."""
    made = [
        row("command", tag("code", " ".join(["crashsim", record.text("command"), *record.texts("arguments")]))),
        row("crashsim", f"version {record.text('version')}"),
    ]
    inputs = [row(file.text("path"), tag("code", file.text("sha256"))) for file in record.nodes("inputs")]
    options = record.node("options")
    listed = [row(tag("code", name), value) for name, value in _options(options)] if options else []
    return [
        table("What made the results", ["", "value"], [*made]),
        *([table("Inputs", ["file", "SHA-256"], [*inputs], class_="hashes")] if inputs else []),
        *(
            [tag("details", tag("summary", "All options"), table("Options", ["option", "value"], [*listed]))]
            if listed
            else []
        ),
    ]


def _options(options: Node, prefix: str = "") -> Iterator[tuple[str, str]]:
    for key, value in options.values.items():
        if isinstance(value, dict):
            yield from _options(Node(options.path, value), f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", _option_value(value)


def _option_value(value: Any) -> str:
    if value is None or value in ("", []):
        return MISSING
    if isinstance(value, list):
        return ", ".join(_option_value(item) for item in value)
    return "yes" if value is True else "no" if value is False else str(value)


def tile_value(name: str, value: float | None) -> Markup:
    """A number large, its unit small."""
    unit = unit_of(name)
    scaled = None if value is None else unit.scale * value
    return Markup(tag("span", shown_number(scaled, 3)) + tag("small", unit.symbol))
