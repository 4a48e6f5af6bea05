"""The report of one case."""

from __future__ import annotations

from . import case_figures as figures
from . import case_tables as tables
from .case import CaseDirectory
from .markup import Content, Markup, tag
from .page import Section, figure_grid, page
from .quantities import outcome_words, shown, words
from .verdict import verdict

TILES = ("max_crush_m", "t_m_s", "peak_decel_g", "olc_g")


def case_page(case: CaseDirectory) -> str:
    """The HTML document of a case."""
    return page(case.title, _header(case), _sections(case))


def _header(case: CaseDirectory) -> Content:
    return [
        tag("p", "Crash model report", class_="kind"),
        tag("h1", case.title),
        tag("p", _subtitle(case), class_="subtitle"),
        tag("div", _tiles(case), class_="tiles"),
        verdict(case),
    ]


def _subtitle(case: CaseDirectory) -> str:
    if case.summary is None:
        return case.path.resolve().name
    facts = [shown(name, value) for name in ("mass_kg", "impact_speed_mps") if (value := case.summary.number(name))]
    return " \u00b7 ".join([*facts, outcome_words(case.outcome)])


def _tiles(case: CaseDirectory) -> list[Markup]:
    test, model = case.part("pulse"), case.summary
    values = {name: model.number(name) if model else None for name in TILES}
    tiles = [_tile(name, value, test.number(name) if test else None) for name, value in values.items() if value]
    return [*tiles, *_rating_tile(case)]


def _rating_tile(case: CaseDirectory) -> list[Markup]:
    rating = case.acceleration_rating
    overall = rating.number("overall") if rating else None
    if rating is None or overall is None:
        return []
    label = tag("p", "acceleration, ISO/TS 18571")
    value = tag("p", f"{overall:.2f}", class_="value")
    return [tag("div", label, value, tag("p", tables.grade_badge(rating.text("grade"))), class_="tile")]


def _tile(name: str, model: float, test: float | None) -> Markup:
    beside = tag("p", f"test {shown(name, test)}") if test is not None else None
    return tag(
        "div", tag("p", words(name)), tag("p", tables.tile_value(name, model), class_="value"), beside, class_="tile"
    )


def _sections(case: CaseDirectory) -> list[Section]:
    model, record = case.model, case.record
    agreement = [*figures.overlays(case), figures.force_over_crush(case)]
    structure = [figures.energy_ledger(case)]
    structure += [*figures.model_curves(model), figures.start_spread(model)] if model else []
    return [
        Section("agreement", "Test and model" if case.pulse else "Motion", [figure_grid(agreement)]),
        Section("ratings", "Ratings", _ratings(case)),
        Section("structure", "Structure", [figure_grid(structure), tables.parameter_table(model) if model else None]),
        Section("body", "Heave and pitch", _body(case)),
        Section("predictions", "Other speeds", [figure_grid(figures.predictions(case)), tables.prediction_table(case)]),
        Section("numbers", "Numbers", [tables.summary_table(case), tables.identification_table(case)]),
        Section("pulse", "Pulse processing", _pulse(case)),
        Section("record", "Record", tables.record_tables(record) if record else []),
    ]


def _ratings(case: CaseDirectory) -> list[Content]:
    text = (
        "ISO/TS 18571 rates a curve against a test: R = 0.4 Z + 0.2 (EP + EM + ES), "
        "excellent above 0.94, good above 0.80, fair above 0.58, else poor."
    )
    found = tables.rating_tables(case)
    return [tag("p", text), found] if found else []


def _body(case: CaseDirectory) -> list[Content]:
    return [figure_grid([*figures.body_motion(case), figures.axle_loads(case)]), tables.coupled_table(case)]


def _pulse(case: CaseDirectory) -> list[Content]:
    """What was done to the trace, as the pulse's file tells."""
    comments = case.pulse.comments if case.pulse else {}
    channels = [tag("li", "channel ", text) for text in comments.get("channel", [])]
    steps = [tag("li", text) for text in comments.get("step", [])]
    return [tag("ol", channels, steps)] if channels or steps else []
