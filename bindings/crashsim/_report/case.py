"""A case directory as a value."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .files import Floats, Node, Table, fault, read_json, read_table

PULSE, MODEL, RESPONSE, PITCH, COUPLED = "pulse.csv", "model.json", "response.csv", "pitch.csv", "coupled.csv"
COMPARISON, SUMMARY, RECORD = "comparison.json", "summary.json", "case.lock.json"
CASE_FILES = (PULSE, MODEL, RESPONSE, PITCH, COUPLED, COMPARISON, SUMMARY, RECORD)
PREDICTION_PREFIX = "prediction_"
FEWEST_SAMPLES = 2


@dataclass(frozen=True)
class Ordinates:
    """Piecewise-linear curve of a model, with the standard errors of its ordinates where they are known."""

    knots: Floats
    values: Floats
    standard_error: Floats | None


@dataclass(frozen=True)
class Rate:
    """The factor 1 + coefficient ln(1 + |v| / reference speed) of the spring's force."""

    coefficient: float
    reference_speed_mps: float
    standard_error: float | None


@dataclass(frozen=True)
class Model:
    """model.json: spring over crush [m], damper over velocity [m/s], and how they were identified.

    With law crush_damping the damper is over crush, with law rate there are a coefficient and a speed instead.
    """

    law: str
    spring: Ordinates | None
    damper: Ordinates | None
    rate: Rate | None
    identification: Node | None


@dataclass(frozen=True)
class CaseDirectory:
    """What a case directory holds; None or empty where a file is not there."""

    path: Path
    pulse: Table | None
    model: Model | None
    response: Table | None
    pitch: Table | None
    coupled: Table | None
    predictions: dict[str, Table]
    comparisons: dict[str, Node]
    summary: Node | None
    record: Node | None

    @property
    def title(self) -> str:
        """Title of the study, else the name of the directory."""
        options = self.record.node("options") if self.record else None
        return (options.text("title") if options else "") or self.path.resolve().name

    @property
    def outcome(self) -> str:
        """Outcome of the whole case, "" when no file tells."""
        return self.summary.text("outcome") if self.summary else ""

    @property
    def acceleration_rating(self) -> Node | None:
        """ISO/TS 18571 rating of the acceleration up to maximum crush."""
        comparison = self.comparisons.get("to_max_crush")
        for channel in comparison.nodes("channels") if comparison else []:
            if channel.text("name") == "accel_mps2":
                return channel.node("iso18571")
        return None

    def part(self, name: str) -> Node | None:
        """A part of the summary."""
        return self.summary.node(name) if self.summary else None


def is_case_directory(path: Path) -> bool:
    """Whether `path` holds a file that `crashsim run` writes."""
    return any((path / name).is_file() for name in CASE_FILES)


def read_case_directory(path: Path) -> CaseDirectory:
    """Reads a case directory, of which any files may be missing. ValueError when one is malformed."""
    summary, record = _read_json(path / SUMMARY), _read_json(path / RECORD)
    comparison = _read_json(path / COMPARISON)
    return CaseDirectory(
        path,
        pulse=_read_motion(path / PULSE),
        model=_read_model(path / MODEL),
        response=_read_motion(path / RESPONSE),
        pitch=_read_motion(path / PITCH),
        coupled=_read_motion(path / COUPLED),
        predictions=_read_predictions(path),
        comparisons=_comparisons(comparison) if comparison else {},
        summary=summary,
        record=record or (comparison.node("record") if comparison else None),
    )


def _read_json(path: Path) -> Node | None:
    return read_json(path) if path.is_file() else None


def _read_motion(path: Path) -> Table | None:
    """A table over time, which increases."""
    if not path.is_file():
        return None
    table = read_table(path)
    time_s = table["time_s"]
    if len(time_s) < FEWEST_SAMPLES:
        raise fault(path, f"has {len(time_s)} sample, need at least {FEWEST_SAMPLES}")
    if not np.all(np.diff(time_s) > 0):
        raise fault(path, "time_s does not increase from line to line")
    return table


def _read_predictions(path: Path) -> dict[str, Table]:
    found = {file.stem.removeprefix(PREDICTION_PREFIX): file for file in path.glob(f"{PREDICTION_PREFIX}*.csv")}
    tables = {name: table for name in sorted(found) if (table := _read_motion(found[name])) is not None}
    return dict(sorted(tables.items(), key=lambda item: (item[1].number("impact_speed_mps") or 0.0, item[0])))


def _comparisons(comparison: Node) -> dict[str, Node]:
    parts = {name: comparison.node(name) for name in comparison.values if name != "record"}
    return {name: part for name, part in parts.items() if part is not None}


def _read_model(path: Path) -> Model | None:
    if not path.is_file():
        return None
    model = read_json(path)
    fit = model.node("identification")
    errors = fit.node("standard_error") if fit else None
    law = model.text("law") or "stiffness"
    spring = _ordinates(model, "spring", ("knots_m", "ordinates_n_per_m", "ordinates_n"), errors)
    damper_knots = "knots_m" if law == "crush_damping" else "knots_mps"
    damper = _ordinates(model, "damper", (damper_knots, "ordinates_ns_per_m"), errors)
    if spring is None and damper is None:
        raise fault(path, "has no spring and no damper")
    return Model(law, spring, damper, _rate(model, errors) if law == "rate" else None, fit)


def _rate(model: Node, errors: Node | None) -> Rate:
    part = model.node("rate")
    r, v_ref = (part.number(key) if part else None for key in ("coefficient", "reference_speed_mps"))
    if r is None or v_ref is None or v_ref <= 0:
        raise fault(model.path, "has law rate, must have rate.coefficient and rate.reference_speed_mps > 0")
    error = errors.numbers("rate") if errors else np.array([])
    return Rate(r, v_ref, float(error[0]) if len(error) == 1 else None)


def _ordinates(model: Node, name: str, keys: tuple[str, ...], errors: Node | None) -> Ordinates | None:
    part = model.node(name)
    if part is None:
        return None
    knots = part.numbers(keys[0])
    values = next((part.numbers(key) for key in keys[1:] if key in part.values), np.array([]))
    if len(knots) == 0 or len(knots) != len(values):
        raise fault(model.path, f"{name} has {len(knots)} knots and {len(values)} ordinates, must be as many")
    standard_error = errors.numbers(name) if errors else np.array([])
    return Ordinates(knots, values, standard_error if len(standard_error) == len(knots) else None)
