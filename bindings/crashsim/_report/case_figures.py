"""The figures of one case."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from .case import CaseDirectory, Model, Ordinates
from .figures import Axis, Curve, Figure
from .files import Floats, Table
from .quantities import (
    KILOJOULE,
    KILONEWTON,
    KILONEWTON_PER_METRE,
    KILONEWTON_SECOND_PER_METRE,
    METRE_PER_SECOND,
    MILLIMETRE,
    MILLISECOND,
    Unit,
    speed_name,
    unit_of,
    words,
)

Points: TypeAlias = tuple[Floats, Floats]

DASHES = ("solid", "dash", "dashdot", "dot", "longdash")
SERIES_COLORS = 6
MOST_STACKED_POINTS = 400
AT_BEST = 1.001
TIME, CRUSH, VELOCITY = Axis("time", "ms"), Axis("crush", "mm"), Axis("velocity", "m/s")
FASTEST_MPS = 20.0  # to which a rate is drawn


def series_color(index: int) -> str:
    """Colour of the index-th of several models."""
    return f"series-{index % SERIES_COLORS + 1}"


def series_dash(index: int) -> str:
    """Dash of the index-th of several models, which tells them apart in grey."""
    return DASHES[index % len(DASHES)]


def _over_time(table: Table, quantity: str, name: str, color: str, dash: str = "solid", width: float = 2.0) -> Curve:
    x, y = MILLISECOND.scale * table["time_s"], unit_of(quantity).scale * table[quantity]
    return Curve(name, x, y, color, dash, width=width)


def _time_of_max_crush(case: CaseDirectory) -> float | None:
    """t_m of the test, else of the model [ms]."""
    for part in (case.part("pulse"), case.summary):
        if part is not None and (time_s := part.number("t_m_s")) is not None:
            return MILLISECOND.scale * time_s
    return None


def overlays(case: CaseDirectory) -> list[Figure]:
    """Acceleration, velocity and crush over time, test and model."""
    captions = {
        "accel_mps2": "Negative while the vehicle decelerates.",
        "velocity_mps": "From the impact speed through zero, where crush is largest, to rebound.",
        "displacement_m": "How much the front has shortened.",
    }
    return [_overlay(case, quantity, caption) for quantity, caption in captions.items() if case.pulse or case.response]


def _overlay(case: CaseDirectory, quantity: str, caption: str) -> Figure:
    curves = []
    if case.pulse:
        curves.append(_over_time(case.pulse, quantity, "test", "test", width=3.5))
    if case.response:
        curves.append(_over_time(case.response, quantity, "model", "model"))
    title = f"{words(quantity).capitalize()} over time"
    axis = Axis(words(quantity), unit_of(quantity).symbol)
    return Figure(quantity, title, caption, TIME, axis, curves, _time_of_max_crush(case), "maximum crush")


def measured_force(pulse: Table) -> Points | None:
    """Crush [mm] and force -m a [kN] of a test; None when its mass is not known."""
    mass_kg = pulse.number("mass_kg")
    return None if mass_kg is None else _over_crush(pulse, -mass_kg * pulse["accel_mps2"])


def model_force(response: Table) -> Points:
    """Crush [mm] and force [kN] of spring and damper together."""
    return _over_crush(response, response["spring_force_n"] + response["damper_force_n"])


def _over_crush(table: Table, force_n: Floats) -> Points:
    """Where the vehicle is at the barrier: not where it is on its way back."""
    is_there = table["displacement_m"] >= 0
    return MILLIMETRE.scale * table["displacement_m"][is_there], KILONEWTON.scale * force_n[is_there]


def force_over_crush(case: CaseDirectory) -> Figure | None:
    """Force over crush of test and model, with the model's spring and damper."""
    curves: list[Curve] = []
    if case.pulse and (force := measured_force(case.pulse)):
        curves.append(Curve("test, mass \u00d7 deceleration", *force, color="test", width=3.5))
    if case.response:
        curves.append(Curve("model", *model_force(case.response), color="model"))
        for name, dash in (("spring", "dash"), ("damper", "dashdot")):
            part = _over_crush(case.response, case.response[f"{name}_force_n"])
            curves.append(Curve(name, *part, color=name, dash=dash, width=1.5))
    caption = "The area under a curve is the energy absorbed."
    return Figure("force-crush", "Force over crush", caption, CRUSH, Axis("force", "kN"), curves) if curves else None


def model_curves(model: Model) -> list[Figure]:
    """k(x), or the spring's force f(x), and c(v), c(x) or the rate's factor, by law."""
    at_bound = set(model.identification.texts("at_bound") if model.identification else [])
    if model.law == "stiffness":
        title, spring_axis = "Spring: stiffness k(x)", Axis("stiffness k", "kN/m")
        spring_unit = KILONEWTON_PER_METRE
    else:
        title, spring_axis, spring_unit = "Spring: force f(x)", Axis("force f", "kN"), KILONEWTON
    caption = "Linear between the knots. Bars: one standard error, where the identification gives it."
    figures = []
    if model.spring:
        spring = _ordinate_curves(model.spring, "spring", "k", at_bound, MILLIMETRE, spring_unit)
        figures.append(Figure("spring", title, caption, CRUSH, spring_axis, spring))
    if model.damper:
        is_over_crush = model.law == "crush_damping"
        title, axis = ("Damper: c(x)", CRUSH) if is_over_crush else ("Damper: c(v)", VELOCITY)
        unit = MILLIMETRE if is_over_crush else METRE_PER_SECOND
        damper = _ordinate_curves(model.damper, "damper", "c", at_bound, unit, KILONEWTON_SECOND_PER_METRE)
        figures.append(Figure("damper", title, caption, axis, Axis("damping c", "kN s/m"), damper))
    if model.rate:
        caption = f"1 + r ln(1 + |v| / v_ref), r = {model.rate.coefficient:.4g}, "
        caption += f"v_ref = {model.rate.reference_speed_mps:.4g} m/s: what the spring's force is multiplied by."
        speed = np.linspace(0.0, FASTEST_MPS, 101)
        factor = 1.0 + model.rate.coefficient * np.log1p(speed / model.rate.reference_speed_mps)
        curves = [Curve("rate", speed, factor, "damper")]
        figures.append(Figure("rate", "Rate", caption, VELOCITY, Axis("factor", ""), curves))
    return figures


def _ordinate_curves(
    ordinates: Ordinates, name: str, letter: str, at_bound: set[str], x_unit: Unit, y_unit: Unit
) -> list[Curve]:
    x, y = x_unit.scale * ordinates.knots, y_unit.scale * ordinates.values
    error = None if ordinates.standard_error is None else y_unit.scale * ordinates.standard_error
    curves = [Curve(name, x, y, name, mode="lines+markers", error=error)]
    bound = np.array([f"{letter}{i}" in at_bound for i in range(1, len(x) + 1)])
    if bound.any():
        curves.append(Curve("at its bound", x[bound], y[bound], "alert", mode="markers", symbol="square-open"))
    return curves


def energy_ledger(case: CaseDirectory) -> Figure | None:
    """Where the kinetic energy of impact goes."""
    mass_kg = case.response.number("mass_kg") if case.response else None
    if case.response is None or mass_kg is None:
        return None
    table, count = case.response, len(case.response["time_s"])
    kept = np.unique(np.linspace(0, count - 1, min(count, MOST_STACKED_POINTS)).round().astype(int))
    time, velocity = MILLISECOND.scale * table["time_s"][kept], table["velocity_mps"]
    parts = {
        "damper, dissipated": ("damper", _work(table, "damper_force_n")),
        "spring, absorbed": ("spring", _work(table, "spring_force_n")),
        "kinetic": ("kinetic", mass_kg * velocity**2 / 2),
    }
    curves = [
        Curve(name, time, KILOJOULE.scale * energy[kept], color, stacked=True)
        for name, (color, energy) in parts.items()
    ]
    caption = f"The parts add up to the kinetic energy of impact. {_residual_words(table)}".strip()
    mark = _time_of_max_crush(case)
    return Figure("energy", "Energy ledger", caption, TIME, Axis("energy", "kJ"), curves, mark, "maximum crush")


def _work(table: Table, force: str) -> Floats:
    """Work of a force along the crush [J], by trapezoids over the samples."""
    force_n = table[force]
    steps = np.diff(table["displacement_m"]) * (force_n[1:] + force_n[:-1]) / 2
    return np.concatenate(([0.0], np.cumsum(steps)))


def _residual_words(table: Table) -> str:
    residual_j = table.columns.get("energy_residual_j", np.array([]))
    known_j = np.abs(residual_j[np.isfinite(residual_j)])
    return f"The simulation's own balance closes within {known_j.max():.1g} J." if len(known_j) else ""


def start_spread(model: Model) -> Figure | None:
    """Error that each start of the identification reached, sorted."""
    errors = model.identification.numbers("start_errors") if model.identification else np.array([])
    reached = np.sort(errors[np.isfinite(errors)])
    if len(reached) == 0:
        return None
    rank = np.arange(1.0, len(reached) + 1)
    best = reached <= AT_BEST * reached[0]
    curves = [Curve(f"within 0.1 % of the best: {best.sum()}", rank[best], reached[best], "model", mode="markers")]
    if not best.all():
        others = Curve(f"others: {(~best).sum()}", rank[~best], reached[~best], "alert", mode="markers")
        curves.append(others)
    failed = len(errors) - len(reached)
    caption = "A long flat foot: many starts found the same answer." + (f" {failed} starts failed." if failed else "")
    axis = Axis("error E", log=bool(reached[0] > 0))
    return Figure("starts", "Starts of the identification", caption, Axis("start, sorted", integers=True), axis, curves)


def body_motion(case: CaseDirectory) -> list[Figure]:
    """Pitch, heave and heave velocity of the two-phase and of the coupled simulation."""
    captions = {
        "pitch_rad": "Nose down is positive.",
        "heave_m": "Of the centre of gravity; up is positive.",
        "heave_velocity_mps": "Vertical velocity of the centre of gravity; up is positive.",
        "pitch_rate_radps": "Nose down is positive.",
    }
    tables = [(case.pitch, "crush first, then heave and pitch", "series-1", "solid")]
    tables.append((case.coupled, "crush, heave and pitch coupled", "series-2", "dash"))
    present = [(table, name, color, dash) for table, name, color, dash in tables if table is not None]
    figures = []
    for quantity, caption in captions.items() if present else ():
        curves = [_over_time(table, quantity, name, color, dash) for table, name, color, dash in present]
        axis = Axis(words(quantity), unit_of(quantity).symbol)
        title = f"{words(quantity).capitalize()} over time"
        figures.append(Figure(quantity, title, caption, TIME, axis, curves))
    return figures


def axle_loads(case: CaseDirectory) -> Figure | None:
    """Axle loads of the coupled simulation."""
    if case.coupled is None:
        return None
    names = {"front_axle_load_n": "front axle", "rear_axle_load_n": "rear axle"}
    curves = [
        _over_time(case.coupled, quantity, name, series_color(i), series_dash(i))
        for i, (quantity, name) in enumerate(names.items())
    ]
    caption = "Of the coupled simulation. Zero: the wheels are about to leave the ground."
    return Figure("axle-loads", "Axle loads over time", caption, TIME, Axis("load", "kN"), curves)


def predictions(case: CaseDirectory) -> list[Figure]:
    """Acceleration over time, crush over time and force over crush at every speed."""
    if not case.predictions:
        return []
    tables = list(_at_speeds(case))
    figures = []
    for quantity in ("accel_mps2", "displacement_m"):
        curves = [_over_time(table, quantity, name, color, dash) for name, table, color, dash in tables]
        axis = Axis(words(quantity), unit_of(quantity).symbol)
        title = f"{words(quantity).capitalize()} over time, by speed"
        figures.append(Figure(f"predicted-{quantity}", title, "Of the model.", TIME, axis, curves))
    curves = [Curve(name, *model_force(table), color=color, dash=dash) for name, table, color, dash in tables]
    title = "Force over crush, by speed"
    figures.append(Figure("predicted-force", title, "Of the model.", CRUSH, Axis("force", "kN"), curves))
    return figures


def _at_speeds(case: CaseDirectory) -> Iterator[tuple[str, Table, str, str]]:
    """Simulations by speed: the case's own, then the predictions."""
    if case.response:
        speed_mps = case.response.number("impact_speed_mps")
        own = "model" if speed_mps is None else f"{3.6 * speed_mps:.4g} km/h, the case"
        yield own, case.response, "model", "solid"
    for index, (name, table) in enumerate(case.predictions.items(), 1):
        yield speed_name(name), table, series_color(index), series_dash(index)
