"""Designs with the coupled model against closed forms and the command line's numbers."""

from __future__ import annotations

import json
import math
import os
import signal
import threading
import time
from pathlib import Path
from typing import Any

import pytest

import crashsim
from support import DATA, assert_value, run_program

MASS, STIFFNESS, SPEED = 1500.0, 1.2e6, 15.0
SLOPE, OPTIMUM = 1e-4, 1e-4
LINEAR = crashsim.CoupledModel(
    crush=crashsim.CrushModel(
        mass_kg=MASS,
        impact_speed_mps=SPEED,
        spring=crashsim.PiecewiseLinear([0], [STIFFNESS]),
        damper=crashsim.PiecewiseLinear([0], [0]),
    ),
    body=crashsim.HeavePitchModel(
        pitch_inertia_kgm2=2500,
        front_axle_m=1.2,
        rear_axle_m=1.4,
        front_stiffness_n_per_m=40e3,
        rear_stiffness_n_per_m=40e3,
        front_damping_ns_per_m=2e3,
        rear_damping_ns_per_m=2e3,
        cg_height_m=0.55,
        force_height_m=0.55,
    ),
)
STIFFNESS_ONLY: dict[str, Any] = {
    "parameters": ["k1"],
    "lower": ["0.3e6 N/m"],
    "upper": [3e6],
    "end_time_s": "0.12 s",
    "starts": 2,
    "jobs": 1,
}


def derivative(result: crashsim.DesignResult, response: str) -> float:
    return next(s.derivative for s in result.sensitivities if s.response == response)


def test_sensitivities_of_a_linear_spring_are_the_closed_forms() -> None:
    result = crashsim.design(LINEAR, minimise="none", **STIFFNESS_ONLY)
    omega = math.sqrt(STIFFNESS / MASS)
    crush, t_m = SPEED / omega, math.pi / 2 / omega
    assert result.usable, result.message
    assert derivative(result, "max_crush_m") == pytest.approx(-crush / 2 / STIFFNESS, rel=SLOPE)
    assert derivative(result, "t_m_s") == pytest.approx(-t_m / 2 / STIFFNESS, rel=SLOPE)
    assert result.before.max_crush_m == pytest.approx(crush, rel=1e-6)
    for value in (result, result.before, result.variables[0], result.sensitivities[0]):
        assert_value(value)


def test_the_optimum_lies_on_its_limit_and_the_trade_off_on_the_hyperbola() -> None:
    done: list[int] = []
    result = crashsim.design(
        LINEAR,
        minimise="peak_decel",
        max_crush_m="700 mm",
        trade_off="max_crush",
        trade_off_limits=["0.5", "600 mm"],
        progress=lambda count, total: done.append(count),
        **STIFFNESS_ONLY,
    )
    assert result.usable, result.message
    assert result.after.peak_decel_g == pytest.approx(SPEED**2 / 0.7 / crashsim.STANDARD_GRAVITY_MPS2, rel=OPTIMUM)
    assert result.limits[0].active and result.limits[0].quantity == "max_crush"
    assert result.optimum.crush.spring.ordinates[0] == result.variables[0].after
    assert [point.limit for point in result.trade_off] == [0.5, 0.6]
    for point in result.trade_off:
        closed = SPEED**2 / point.limit / crashsim.STANDARD_GRAVITY_MPS2
        assert point.feasible and point.objective == pytest.approx(closed, rel=OPTIMUM)
        assert_value(point)
    assert crashsim.quantity_of(result.after, "peak_decel") == result.after.peak_decel_g
    assert done == sorted(done)
    assert_value(result.limits[0])


NEON: dict[str, Any] = {
    "parameters": ["k1", "k2", "force_height"],
    "lower": ["50 kN", "300 kN", "0.45 m"],
    "upper": ["300 kN", "1400 kN", "0.55 m"],
    "minimise": "olc",
    "max_crush_m": "0.52 m",
    "max_pitch_rad": "4 deg",
    "starts": 1,
    "end_time_s": "0.35 s",
    "dt_s": "0.2 ms",
}


def neon() -> crashsim.CoupledModel:
    """The model of data/design/case.toml."""
    body = crashsim.HeavePitchModel(
        pitch_inertia_kgm2=2000,
        front_axle_m="1.05 m",
        rear_axle_m="1.55 m",
        front_stiffness_n_per_m="44 kN/m",
        rear_stiffness_n_per_m="40 kN/m",
        front_damping_ns_per_m="3.2 kN s/m",
        rear_damping_ns_per_m="3.0 kN s/m",
        cg_height_m="0.54 m",
        force_height_m="0.48 m",
        force_arm_m="1.3 m",
    )
    crush = crashsim.read_model(DATA / "neon-kw400" / "model.json")
    return crashsim.CoupledModel(crush=crush, body=body, vertical=crashsim.VerticalForceLaw(angle_rad="1 deg"))


def test_a_design_is_the_command_lines(tmp_path: Path) -> None:
    lines = (DATA / "design" / "case.toml").read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if not line.startswith(("trade_off", "starts"))]
    study = "\n".join([*kept, "starts = 1"]).replace("../neon-kw400", str(DATA / "neon-kw400"))
    (tmp_path / "case.toml").write_text(study, encoding="utf-8")
    run_program("design", tmp_path / "case.toml", "-o", tmp_path / "design")
    told = json.loads((tmp_path / "design" / "design.json").read_text(encoding="utf-8"))
    result = crashsim.design(neon(), **NEON)
    assert result.outcome == told["outcome"]
    for name in crashsim.DesignResponses._fields:
        assert getattr(result.before, name) == told["before"][name], name
        assert getattr(result.after, name) == told["after"][name], name
    for variable, expected in zip(result.variables, told["parameters"], strict=True):
        assert {name: getattr(variable, name) for name in expected} == expected


def test_a_progress_function_stops_a_design() -> None:
    options: dict[str, Any] = {**NEON, "starts": 50}
    stopped = crashsim.design(neon(), progress=lambda done, total: False, **options)
    assert stopped.outcome == "interrupted" and not stopped.usable


def test_control_c_stops_a_design_within_a_second() -> None:
    pressed: list[float] = []

    def press() -> None:
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    options: dict[str, Any] = {**NEON, "starts": 1000}
    threading.Timer(0.2, press).start()
    with pytest.raises(KeyboardInterrupt):
        crashsim.design(neon(), **options)
    assert time.monotonic() - pressed[0] < 1.0


def test_errors_name_the_keyword_and_the_quantity() -> None:
    with pytest.raises(crashsim.InvalidInput, match="parameters"):
        crashsim.design(LINEAR)
    with pytest.raises(TypeError, match=r"design.*'max_crush'; did you mean 'max_crush_m'"):
        crashsim.design(LINEAR, max_crush=0.5)  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="quantity: unknown name 'crush'"):
        crashsim.quantity_of(crashsim.DesignResponses(), "crush")


def test_a_design_not_computed_is_unset() -> None:
    assert math.isnan(crashsim.design_responses(crashsim.CoupledResponse()).olc_g)
    assert crashsim.DesignResult().brief_report() == "not run"
