"""Words, units and figures of numbers: how a quantity named as in the files is shown to a person."""

from __future__ import annotations

import math
from typing import NamedTuple

STANDARD_GRAVITY_MPS2 = 9.80665
MISSING = "\u2013"
SIGNIFICANT, MOST_PLACES = 4, 7


class Unit(NamedTuple):
    """How an SI value is shown."""

    scale: float
    symbol: str


MILLIMETRE, MILLISECOND, GRAVITY = Unit(1e3, "mm"), Unit(1e3, "ms"), Unit(1 / STANDARD_GRAVITY_MPS2, "g")
KILOMETRE_PER_HOUR, METRE_PER_SECOND, NONE = Unit(3.6, "km/h"), Unit(1.0, "m/s"), Unit(1.0, "")
KILONEWTON, KILOJOULE, DEGREE = Unit(1e-3, "kN"), Unit(1e-3, "kJ"), Unit(180 / math.pi, "deg")
DEGREE_PER_SECOND, KILONEWTON_PER_METRE = Unit(180 / math.pi, "deg/s"), Unit(1e-3, "kN/m")
KILONEWTON_SECOND_PER_METRE = Unit(1e-3, "kN s/m")

UNIT_OF_NAME = {"heave_velocity_mps": METRE_PER_SECOND, "heave_velocity_min_mps": METRE_PER_SECOND}
UNIT_OF_SUFFIX = (  # the longest suffix of a name first
    ("_ns_per_m", KILONEWTON_SECOND_PER_METRE),
    ("_n_per_m", KILONEWTON_PER_METRE),
    ("_radps", DEGREE_PER_SECOND),
    ("_mps2", GRAVITY),
    ("_mps", KILOMETRE_PER_HOUR),
    ("_rad", DEGREE),
    ("_kg", Unit(1.0, "kg")),
    ("_g", Unit(1.0, "g")),
    ("_j", KILOJOULE),
    ("_n", KILONEWTON),
    ("_m", MILLIMETRE),
    ("_s", MILLISECOND),
)

WORDS = {
    "mass_kg": "test mass",
    "impact_speed_mps": "impact speed",
    "t_m_s": "time of maximum crush",
    "max_crush_m": "maximum dynamic crush",
    "static_crush_m": "crush left after separation",
    "peak_decel_g": "peak deceleration",
    "mean_decel_g": "mean deceleration to maximum crush",
    "delta_v_mps": "change of velocity",
    "rebound_velocity_mps": "rebound velocity",
    "restitution": "coefficient of restitution",
    "centroid_s": "time centroid of the pulse",
    "olc_g": "occupant load criterion (OLC)",
    "sm10_g": "largest 10 ms mean",
    "sm25_g": "largest 25 ms mean",
    "sm38_g": "largest 38 ms mean",
    "sm50_g": "largest 50 ms mean",
    "asi": "acceleration severity index (ASI)",
    "vpi_g": "vehicle pulse index (VPI)",
    "kw400_n_per_m": "work-equivalent stiffness (KW400)",
    "energy_j": "energy absorbed to maximum crush",
    "pitch_max_rad": "largest pitch, nose down",
    "pitch_max_time_s": "time of the largest pitch",
    "heave_min_m": "lowest heave",
    "heave_min_time_s": "time of the lowest heave",
    "heave_velocity_min_mps": "fastest drop",
    "displacement_max_m": "largest travel of the centre of gravity",
    "displacement_max_time_s": "time of the largest travel",
    "separation_s": "time contact was lost",
    "front_axle_load_max_n": "largest load of the front axle",
    "front_axle_load_min_n": "smallest load of the front axle",
    "rear_axle_load_min_n": "smallest load of the rear axle",
    "front_lift_off_s": "time the front wheels leave the ground",
    "rear_lift_off_s": "time the rear wheels leave the ground",
    "kinetic_energy_j": "kinetic energy at the end",
    "crush_energy_j": "energy absorbed by the structure",
    "suspension_energy_j": "energy stored in suspension and height",
    "suspension_dissipated_j": "energy dissipated by the suspension",
    "vertical_work_j": "work against the vertical force",
    "error": "error E of the fit",
    "error_accel": "its part of acceleration",
    "error_velocity": "its part of velocity",
    "error_displacement": "its part of displacement",
    "starts": "starts",
    "starts_at_best": "starts within 0.1 % of the best",
    "identifiable": "every ordinate determined",
    "rank": "rank of the sensitivities",
    "condition": "their condition number",
    "evaluations": "evaluations of E and its gradient",
    "accel_mps2": "acceleration",
    "velocity_mps": "velocity",
    "displacement_m": "crush",
    "heave_m": "heave",
    "heave_velocity_mps": "heave velocity",
    "pitch_rad": "pitch",
    "pitch_rate_radps": "pitch rate",
}

OUTCOMES = {
    "completed": "completed",
    "not_run": "not run",
    "no_max_crush": "no maximum crush within the simulated time",
    "left_knot_range": "the motion left the knots of a curve",
    "unloading_too_soft": "the unloading line would give back more energy than was absorbed",
    "step_limit": "the integrator needed too many steps",
    "failed": "the integration failed",
    "interrupted": "interrupted",
    "every_start_failed": "every start of the identification failed",
    "engines_disagree": "the two integrators disagree",
}


def words(name: str) -> str:
    """What a quantity is called."""
    return WORDS.get(name, name.replace("_", " "))


def outcome_words(outcome: str) -> str:
    """What an outcome means."""
    return OUTCOMES.get(outcome, outcome.replace("_", " ")) or "unknown"


def unit_of(name: str) -> Unit:
    """Unit in which a quantity is shown, by the suffix of its name."""
    if name in UNIT_OF_NAME:
        return UNIT_OF_NAME[name]
    return next((unit for suffix, unit in UNIT_OF_SUFFIX if name.endswith(suffix)), NONE)


def shown_number(value: float | None, digits: int = SIGNIFICANT) -> str:
    """A number to `digits` significant digits, with an exponent only where it is very small or very large."""
    if value is None or not math.isfinite(value):
        return MISSING
    if value == 0:
        return "0"
    magnitude = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    is_plain = -digits <= magnitude < MOST_PLACES
    text = f"{value:.{max(0, digits - 1 - magnitude)}f}" if is_plain else f"{value:.{digits - 1}e}"
    return text.replace("-", "\u2212")


def shown(name: str, value: float | None) -> str:
    """A quantity with its unit."""
    unit = unit_of(name)
    if value is None:
        return MISSING
    return f"{shown_number(value * unit.scale)} {unit.symbol}".rstrip()


def speed_name(table_name: str) -> str:
    """Name of a prediction for people: "48 km/h" of "48kmh"."""
    return f"{table_name.removesuffix('kmh')} km/h" if table_name.endswith("kmh") else table_name
