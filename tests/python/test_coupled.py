"""Crush, heave and pitch as one model against closed forms and the program's own file."""

from __future__ import annotations

import math

import numpy as np
import pytest

import crashsim
from support import assert_value

MASS, STIFFNESS, SPEED = 1500.0, 1.2e6, 15.0
SOLVER = 1e-6
CRUSH = crashsim.CrushModel(
    mass_kg=MASS, spring=crashsim.PiecewiseLinear([0], [STIFFNESS]), damper=crashsim.PiecewiseLinear([0], [0])
)
BODY = crashsim.HeavePitchModel(
    pitch_inertia_kgm2=2500,
    front_axle_m=1.2,
    rear_axle_m=1.4,
    front_stiffness_n_per_m=40e3,
    rear_stiffness_n_per_m=40e3,
    front_damping_ns_per_m=2e3,
    rear_damping_ns_per_m=2e3,
    cg_height_m=0.55,
    force_height_m=0.55,
    force_arm_m=1.0,
)
MODEL = crashsim.CoupledModel(crush=CRUSH, body=BODY)


def test_without_lever_the_crush_is_that_of_the_closed_form() -> None:
    run = crashsim.simulate_coupled(MODEL, impact_speed_mps="54 km/h", end_time_s=0.08)
    omega = math.sqrt(STIFFNESS / MASS)
    assert run.usable and run.outcome == "completed"
    assert run.max_crush_m == pytest.approx(SPEED / omega, rel=SOLVER)
    assert run.t_m_s == pytest.approx(math.pi / 2 / omega, rel=SOLVER)
    touching = run.time_s < math.pi / omega
    closed = SPEED / omega * np.sin(omega * run.time_s[touching])
    np.testing.assert_allclose(run.crush_m[touching], closed, atol=SOLVER * SPEED / omega)
    np.testing.assert_allclose(run.pitch_rad, 0, atol=1e-12)
    weight = MASS * crashsim.STANDARD_GRAVITY_MPS2
    assert run.front_axle_load_n[0] == pytest.approx(weight * 1.4 / 2.6, rel=1e-12)
    assert_value(run)


def test_energies_balance_and_the_nose_goes_down_under_a_low_force() -> None:
    low = MODEL.replace(
        body=BODY.replace(force_height_m="0.45 m"),
        vertical=crashsim.VerticalForceLaw(angle_rad="2 deg"),
        ground=crashsim.GroundContact(lift_off=True),
    )
    run = crashsim.simulate_coupled(low, impact_speed_mps=SPEED)
    start = 0.5 * MASS * SPEED**2
    total = (
        run.kinetic_energy_j
        + run.crush_energy_j
        + run.suspension_energy_j
        + run.suspension_dissipated_j
        + run.vertical_work_j
    )
    assert total == pytest.approx(start, rel=SOLVER)
    assert abs(run.energy_residual_j).max() < SOLVER * start
    assert run.pitch_max_rad > 0.01
    tangent = math.tan(math.radians(2))
    np.testing.assert_allclose(run.vertical_force_n, tangent * run.longitudinal_force_n, rtol=1e-9, atol=1e-6)
    assert low != MODEL
    assert_value(low)


def test_a_series_of_vertical_force_stands_for_the_law() -> None:
    law = MODEL.replace(vertical=crashsim.VerticalForceLaw(angle_rad=0.05))
    by_law = crashsim.simulate_coupled(law, impact_speed_mps=SPEED, dt_s=1e-5, end_time_s=0.1)
    series = (by_law.time_s, by_law.vertical_force_n)
    by_series = crashsim.simulate_coupled(
        MODEL, vertical_force_n=series, impact_speed_mps=SPEED, dt_s=1e-5, end_time_s=0.1
    )
    np.testing.assert_allclose(by_series.pitch_rad, by_law.pitch_rad, atol=1e-5 * by_law.pitch_max_rad)
    with pytest.raises(crashsim.InvalidInput):
        crashsim.simulate_coupled(law, vertical_force_n=series, impact_speed_mps=SPEED)


def test_metrics_of_a_coupled_motion_are_those_of_its_travel() -> None:
    run = crashsim.simulate_coupled(MODEL, impact_speed_mps=SPEED)
    found = crashsim.metrics(run, mass_kg=MASS)
    assert found.max_crush_m == pytest.approx(run.displacement_max_m, rel=1e-4)
    assert found.energy_j == pytest.approx(0.5 * MASS * SPEED**2, rel=1e-12)


def test_one_mass_is_enough_and_two_must_not_differ() -> None:
    assert MODEL.with_one_mass().body.mass_kg == MASS
    MODEL.with_one_mass().validate()
    with pytest.raises(crashsim.InvalidInput, match="mass_kg"):
        MODEL.replace(body=BODY.replace(mass_kg=1400)).with_one_mass()
    with pytest.raises(crashsim.InvalidInput, match="bump"):
        MODEL.with_one_mass().replace(ground=crashsim.GroundContact(front_bump_gap_m="50 mm")).validate()


def test_errors_name_the_field_and_the_keyword() -> None:
    with pytest.raises(crashsim.InvalidInput, match="impact_speed_mps"):
        crashsim.simulate_coupled(MODEL)
    with pytest.raises(TypeError, match=r"simulate_coupled.*'end_time'; did you mean 'end_time_s'"):
        crashsim.simulate_coupled(MODEL, end_time=0.1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"CoupledModel.crush: .* is of the wrong type"):
        crashsim.CoupledModel(crush=BODY)  # type: ignore[arg-type]


def test_a_response_not_computed_is_unset() -> None:
    empty = crashsim.CoupledResponse()
    assert empty.outcome == "not_run" and not empty.usable
    assert empty.time_s.size == 0 and math.isnan(empty.max_crush_m)
    assert_value(empty)


def test_parts_of_a_model_outlive_it() -> None:
    front = crashsim.CoupledModel(crush=CRUSH, body=BODY).crush.spring.ordinates
    assert front.tolist() == [STIFFNESS]
