"""The report of several cases: a table to sort, small multiples, all curves in one figure."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from .case import CaseDirectory, is_case_directory, read_case_directory
from .case_figures import CRUSH, TIME, Points, measured_force, model_force, series_color, series_dash
from .case_tables import grade_badge
from .figures import Axis, Curve, Figure
from .files import Floats, Table
from .markup import Content, Markup, tag
from .multiples import Panel, multiples
from .page import Section, figure_element, page
from .quantities import (
    GRAVITY,
    MILLISECOND,
    MISSING,
    outcome_words,
    shown_number,
    unit_of,
)

REPORT = "report.html"
MOST_NAMED_CURVES = 12
POINTS_OF_ALL, FEWEST_POINTS, MOST_POINTS = 45_000, 80, 600


@dataclass(frozen=True)
class Entry:
    """A directory of the comparison: its case, or why there is none."""

    path: Path
    case: CaseDirectory | None
    fault: str = ""

    @property
    def status(self) -> str:
        """completed, failed or absent."""
        if self.case is None or not self.case.outcome:
            return "failed" if self.fault else "absent"
        return "completed" if self.case.outcome == "completed" else "failed"

    @property
    def explanation(self) -> str:
        """What the status means in words."""
        if self.fault:
            return self.fault
        if self.case is None or not self.case.outcome:
            return "no result"
        return outcome_words(self.case.outcome)


def find_cases(folder: Path) -> list[Entry]:
    """The cases in the directories of `folder`, by name; an empty directory is a case without a result.

    Empty when no directory holds a file of a case.
    """
    directories = sorted((path for path in folder.iterdir() if path.is_dir() and path.name[0] != "."), key=_natural)
    entries = [_entry(path) for path in directories if is_case_directory(path) or not any(path.iterdir())]
    return entries if any(entry.case or entry.fault for entry in entries) else []


def _natural(path: Path) -> list[tuple[int, int, str]]:
    """Sort key by which case-10 follows case-9."""
    pieces: list[str] = [""]
    for character in path.name:
        if pieces[-1] and pieces[-1][-1].isdecimal() != character.isdecimal():
            pieces.append("")
        pieces[-1] += character
    return [(0, int(piece), piece) if piece.isdecimal() else (1, 0, piece) for piece in pieces]


def _entry(path: Path) -> Entry:
    if not is_case_directory(path):
        return Entry(path, None)
    try:
        return Entry(path, read_case_directory(path))
    except ValueError as error:
        return Entry(path, None, str(error).replace(f"{path}{os.sep}", ""))


@dataclass(frozen=True)
class Column:
    """A column of numbers: heading, unit, and where the number comes from, already in that unit."""

    head: str
    unit: str
    value: Callable[[CaseDirectory], float | None]


def _of_summary(head: str, name: str, part: str | None = None) -> Column:
    unit = unit_of(name)

    def value(case: CaseDirectory) -> float | None:
        node = case.summary if part is None else case.part(part)
        found = node.number(name) if node else None
        return None if found is None else unit.scale * found

    return Column(head, unit.symbol, value)


COLUMNS = (
    _of_summary("mass", "mass_kg"),
    _of_summary("speed", "impact_speed_mps"),
    _of_summary("crush, test", "max_crush_m", "pulse"),
    _of_summary("crush, model", "max_crush_m"),
    _of_summary("t_m", "t_m_s"),
    _of_summary("peak", "peak_decel_g"),
    _of_summary("OLC", "olc_g"),
    _of_summary("error E", "error", "identification"),
)


def comparison_page(folder: Path, entries: list[Entry], target: Path) -> str:
    """The HTML document that compares cases; links are relative to where it is written."""
    counts = {status: sum(entry.status == status for entry in entries) for status in ("completed", "failed", "absent")}
    words = {"completed": "completed", "failed": "failed", "absent": "without a result"}
    facts = [f"{count} {words[status]}" for status, count in counts.items() if count]
    name = folder.resolve().name
    header = [
        tag("p", "Comparison of crash models", class_="kind"),
        tag("h1", name),
        tag("p", f"{len(entries)} cases: {', '.join(facts)}", class_="subtitle"),
    ]
    sections = [
        Section("cases", "Cases", [_table(entries, target)]),
        Section("together", "All in one", [_together(entries)]),
        Section("multiples", "Every case", [_multiples(entries, target)]),
    ]
    return page(f"{name}: comparison", header, sections)


def _table(entries: list[Entry], target: Path) -> Markup:
    texts = [_head("case"), _head("status"), *(_head(column.head, column.unit) for column in COLUMNS)]
    heads = [*texts, _head("rating R")]
    rows = [_row(index, entry, target) for index, entry in enumerate(entries)]
    text = (
        "Choose a heading to sort by it. t_m: time of maximum crush. OLC: occupant load criterion. "
        "Rating R: acceleration up to maximum crush against the test, ISO/TS 18571."
    )
    body = tag("table", tag("thead", tag("tr", heads)), tag("tbody", rows), class_="sortable")
    scroll = tag("div", body, class_="scroll cases", role="region", aria_label="Cases", tabindex="0")
    return Markup(tag("p", text) + scroll)


def _head(text: str, unit: str = "") -> Markup:
    label = [text, tag("small", f" [{unit}]") if unit else None]
    arrow = tag("span", class_="arrow", aria_hidden="true")
    return tag("th", tag("button", label, arrow, type="button"), scope="col", aria_sort="none")


def _row(index: int, entry: Entry, target: Path) -> Markup:
    case = entry.case
    status = tag("span", entry.explanation, class_=f"status {entry.status}")
    cells = [
        tag("th", _link(entry, target), _title(entry), scope="row", data_value=entry.path.name),
        tag("td", status, data_value=f"{entry.status} {entry.explanation}", class_="words"),
    ]
    for column in COLUMNS:
        value = column.value(case) if case else None
        cells.append(tag("td", shown_number(value), data_value="" if value is None else repr(value)))
    return tag("tr", cells, _rating_cell(case), data_case=index, class_=entry.status)


def _title(entry: Entry) -> Markup | None:
    if entry.case is None or entry.case.title == entry.case.path.resolve().name:
        return None
    return tag("small", entry.case.title, class_="title")


def _rating_cell(case: CaseDirectory | None) -> Markup:
    rating = case.acceleration_rating if case else None
    overall = rating.number("overall") if rating else None
    if rating is None or overall is None:
        return tag("td", MISSING, data_value="")
    return tag("td", f"{overall:.3f} ", grade_badge(rating.text("grade")), data_value=repr(overall))


def _link(entry: Entry, target: Path) -> Content:
    """Name of a case, a link where it has a report of its own."""
    if not (entry.path / REPORT).is_file():
        return entry.path.name
    relative = os.path.relpath(entry.path.resolve() / REPORT, target.parent.resolve())
    return tag("a", entry.path.name, href="./" + quote(Path(relative).as_posix()))


def _deceleration(table: Table) -> Points:
    return MILLISECOND.scale * table["time_s"], -GRAVITY.scale * table["accel_mps2"]


def _multiples(entries: list[Entry], target: Path) -> Markup:
    decelerations, forces = [], []
    for entry in entries:
        pulse, response = (entry.case.pulse, entry.case.response) if entry.case else (None, None)
        head, note = (
            _link(entry, target),
            "a file is malformed" if entry.fault else entry.explanation if entry.status != "completed" else "",
        )
        over_time = _deceleration(pulse) if pulse else None, _deceleration(response) if response else None
        over_crush = measured_force(pulse) if pulse else None, model_force(response) if response else None
        decelerations.append(Panel(head, note, *over_time))
        forces.append(Panel(head, note, *over_crush))
    return multiples(
        {
            "Deceleration over time": (TIME, Axis("deceleration", "g"), decelerations),
            "Force over crush": (CRUSH, Axis("force", "kN"), forces),
        }
    )


def _together(entries: list[Entry]) -> Markup | None:
    """The models of all cases in one figure each; the legend stands where it can be read."""
    models = [(entry.path.name, entry.case.response) for entry in entries if entry.case and entry.case.response]
    if not models:
        return None
    named = len(models) <= MOST_NAMED_CURVES
    most_points = max(FEWEST_POINTS, min(MOST_POINTS, POINTS_OF_ALL // len(models)))
    kinds = (
        ("all-decelerations", "Deceleration over time", TIME, Axis("deceleration", "g"), _deceleration),
        ("all-forces", "Force over crush", CRUSH, Axis("force", "kN"), model_force),
    )
    figures = []
    for key, title, x, y, points in kinds:
        curves = [_one_of_many(index, name, *points(table), named=named) for index, (name, table) in enumerate(models)]
        figures.append(figure_element(Figure(key, title, "The models.", x, y, curves), most_points, legend=named))
    return tag("div", figures, class_="figures")


def _one_of_many(index: int, name: str, x: Floats, y: Floats, *, named: bool) -> Curve:
    if named:
        return Curve(name, x, y, series_color(index), series_dash(index))
    return Curve(name, x, y, series_color(index), width=1.0)
