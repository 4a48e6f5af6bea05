"""Metrics, ratings, comparisons and walls against closed forms and the command line's numbers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import crashsim
from support import DATA, assert_value, run_program

ROUNDING = 1e-12
SOLVER = 1e-6
GRAVITY = 9.80665
DECELERATION = 200.0
SPEED = 30.0
TIME = np.linspace(0.0, SPEED / DECELERATION, 1501)
CONSTANT = {
    "time_s": TIME,
    "accel_mps2": np.full_like(TIME, -DECELERATION),
    "velocity_mps": SPEED - DECELERATION * TIME,
    "displacement_m": SPEED * TIME - 0.5 * DECELERATION * TIME**2,
}


def test_metrics_of_constant_deceleration_are_the_closed_forms() -> None:
    found = crashsim.metrics(**CONSTANT, mass_kg="1.5 t")
    assert found.max_crush_m == pytest.approx(SPEED**2 / 2 / DECELERATION, rel=ROUNDING)
    assert found.t_m_s == pytest.approx(SPEED / DECELERATION, rel=ROUNDING)
    assert found.mean_decel_g == pytest.approx(DECELERATION / GRAVITY, rel=ROUNDING)
    assert found.sm50_g == pytest.approx(DECELERATION / GRAVITY, rel=ROUNDING)
    assert found.kw400_n_per_m == pytest.approx(2 * 1500 * DECELERATION / 0.425, rel=SOLVER)
    assert found.energy_j == pytest.approx(1500 * SPEED**2 / 2, rel=ROUNDING)
    assert math.isnan(found.rebound_velocity_mps)
    assert_value(found)


def test_metrics_without_mass_leave_unset_what_needs_it() -> None:
    found = crashsim.metrics(**CONSTANT)
    assert math.isnan(found.energy_j) and math.isnan(found.kw400_n_per_m)
    assert not math.isnan(found.max_crush_m)


def test_metrics_of_a_pulse_are_those_of_its_arrays() -> None:
    longer = 1.1 * TIME
    pulse = crashsim.make_pulse(longer, CONSTANT["accel_mps2"], impact_speed_mps=SPEED, mass_kg=1500)
    arrays = (pulse.time_s, pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m)
    assert crashsim.metrics(pulse) == crashsim.metrics(*arrays, mass_kg=1500)
    assert crashsim.metrics(pulse, mass_kg="3 t").energy_j == pytest.approx(2 * crashsim.metrics(pulse).energy_j)


def test_metrics_are_the_command_lines(tmp_path: Path) -> None:
    model = DATA / "syn-a" / "model.json"
    told = run_program("simulate", model, "-o", tmp_path / "response.csv")
    read = crashsim.read_model(model)
    found = crashsim.metrics(crashsim.simulate(read), mass_kg=read.mass_kg)
    for name in crashsim.Metrics._fields:
        assert getattr(found, name) == told[name], name


def test_metrics_refuse_what_is_no_motion() -> None:
    with pytest.raises(TypeError, match=r"motion: .* has no time_s; give a Pulse"):
        crashsim.metrics(3)  # type: ignore[call-overload]
    with pytest.raises(crashsim.InvalidInput, match="velocity_mps"):
        crashsim.metrics(**{**CONSTANT, "velocity_mps": TIME[:-1]})
    with pytest.raises(crashsim.InvalidInput, match="mass_kg = -1 kg: must be > 0"):
        crashsim.metrics(**CONSTANT, mass_kg=-1)


def test_occupant_load_criterion_of_constant_deceleration_is_the_closed_form() -> None:
    found = crashsim.occupant_load_criterion(TIME, CONSTANT["velocity_mps"], CONSTANT["displacement_m"])
    t1 = math.sqrt(2 * 0.065 / DECELERATION)
    t2 = t1 + 2 * 0.235 / (DECELERATION * t1)
    assert found.t1_s == pytest.approx(t1, rel=ROUNDING)
    assert found.t2_s == pytest.approx(t2, rel=ROUNDING)
    assert found.olc_g == pytest.approx(DECELERATION * t2 / (t2 - t1) / 9.81, rel=ROUNDING)
    assert_value(found)


def test_vehicle_pulse_index_of_constant_deceleration_is_the_closed_form() -> None:
    peak = DECELERATION + math.sqrt(DECELERATION**2 + 2 * DECELERATION * 0.03 * 2500)
    assert crashsim.vehicle_pulse_index(TIME, CONSTANT["accel_mps2"]) == pytest.approx(peak, rel=SOLVER)


def test_sliding_mean_is_unset_where_the_window_is_longer() -> None:
    velocity = CONSTANT["velocity_mps"]
    assert crashsim.sliding_mean_peak(TIME, velocity, 0.05) == pytest.approx(DECELERATION, rel=1e-9)
    assert math.isnan(crashsim.sliding_mean_peak(TIME, velocity, 1.0))
    with pytest.raises(crashsim.InvalidInput, match="window_s = 0 s: must be > 0"):
        crashsim.sliding_mean_peak(TIME, velocity, 0.0)


@pytest.mark.parametrize("method", ["moving_mean_1998", "butterworth_2010"])
def test_severity_of_constant_acceleration_is_that_of_its_axes(method: str) -> None:
    g = np.full(10000, GRAVITY)
    assert crashsim.acceleration_severity_index(12 * g, dt_s=1e-4, method=method) == pytest.approx(1.0, rel=1e-3)
    both = crashsim.acceleration_severity_index(12 * g, az=10 * g, dt_s=1e-4, method=method)
    assert both == pytest.approx(math.sqrt(2.0), rel=1e-3)
    with pytest.raises(crashsim.InvalidInput, match="ay has 5 samples but ax has 10000"):
        crashsim.acceleration_severity_index(g, g[:5], dt_s=1e-4)


def test_severity_knows_its_methods() -> None:
    with pytest.raises(crashsim.InvalidInput, match="known: moving_mean_1998, butterworth_2010"):
        crashsim.acceleration_severity_index(TIME, dt_s=1e-4, method="butterworth")


def test_stiffness_and_height_over_400_mm_are_the_closed_forms() -> None:
    assert crashsim.kw400([0, 0.6], [300e3, 300e3]) == pytest.approx(600e3 / 0.425, rel=ROUNDING)
    assert math.isnan(crashsim.kw400([0, 0.3], [1, 1]))
    assert crashsim.ahof400([0, 0.6], [1e5, 1e5], [0.5, 0.5]) == pytest.approx(0.5, rel=ROUNDING)
    with pytest.raises(crashsim.InvalidInput, match="2 crush samples but 1 force samples"):
        crashsim.kw400([0, 1], [1])


def test_crash3_gives_back_the_energy_of_the_test() -> None:
    crash3 = crashsim.crash3_stiffness("1354 kg", "35 mph", "450 mm", 1.6)
    energy = 1.6 * (crash3.g_n + crash3.a_n_per_m * 0.45 + crash3.b_n_per_m2 * 0.45**2 / 2)
    assert crashsim.energy_equivalent_speed(energy, 1354) == pytest.approx(crashsim.quantity("35 mph"), rel=ROUNDING)
    assert_value(crash3)
    with pytest.raises(crashsim.InvalidInput, match="residual_crush_m = 0 m: must be > 0"):
        crashsim.crash3_stiffness(1354, 15, 0, 1.6)


def test_a_curve_rates_itself_excellent() -> None:
    curve = np.sin(np.linspace(0, 3, 500))
    rating = crashsim.rate(curve, curve[::1], "0.1 ms")
    assert [getattr(rating, name) for name in rating._fields] == [1.0] * 5
    assert rating.grade == "excellent"
    assert crashsim.grade(math.nan) == "unrated"
    assert_value(rating)


def test_rate_takes_strided_and_integer_arrays_and_refuses_others() -> None:
    table = np.zeros((200, 2), dtype=np.int32, order="F")
    table[:, 1] = np.arange(200)
    assert crashsim.rate(table[::2, 1], table[::2, 1], 1e-4).overall == 1.0
    with pytest.raises(crashsim.InvalidInput, match="reference: must be one-dimensional"):
        crashsim.rate(table, table, 1e-4)
    with pytest.raises(TypeError, match="reference: must be an array of real numbers"):
        crashsim.rate(np.zeros(20, dtype=complex), np.zeros(20), 1e-4)
    with pytest.raises(crashsim.InvalidInput, match="zero throughout"):
        crashsim.rate(np.zeros(20), np.ones(20), 1e-4)


def test_errors_are_the_plain_formulas() -> None:
    a, b = np.array([1.0, -4.0, 2.0]), np.array([1.5, -4.0, 1.0])
    found = crashsim.errors(a, b)
    assert found.mean_abs == pytest.approx(np.mean(abs(a - b)), rel=ROUNDING)
    assert found.rms == pytest.approx(np.sqrt(np.mean((a - b) ** 2)), rel=ROUNDING)
    assert found.max_abs == 1.0
    assert found.mean_abs_relative == pytest.approx(found.mean_abs / 4, rel=ROUNDING)
    assert_value(found)


def test_comparison_is_the_command_lines(tmp_path: Path) -> None:
    model = DATA / "syn-a" / "model.json"
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    run_program("simulate", model, "-o", files[0])
    run_program("simulate", model, "--speed", 15, "-o", files[1])
    told = run_program("compare", *files, "--end", "0.09", "-o", tmp_path / "rating.json")
    read = crashsim.read_model(model)
    runs = [crashsim.simulate(read), crashsim.simulate(read, impact_speed_mps=15)]
    for pair in (runs, [crashsim.read_traces(file) for file in files]):
        found = crashsim.compare(*pair, end_s="90 ms")
        for channel, expected in zip(found.channels[:3], told["channels"], strict=False):
            assert channel.name == expected["name"] and channel.unit == expected["unit"]
            for name in crashsim.ErrorSummary._fields:
                assert getattr(channel.errors, name) == expected["errors"][name]
            for name in crashsim.Rating._fields:
                assert getattr(channel.rating, name) == expected["iso18571"][name]
        assert_value(found)
    velocity = crashsim.rate(*runs, channel="velocity_mps", end_s=0.09)  # type: ignore[arg-type]
    assert velocity == crashsim.compare(*runs, end_s=0.09).channels[1].rating


def test_compare_tells_what_is_missing() -> None:
    run = crashsim.simulate(crashsim.read_model(DATA / "syn-a" / "model.json"))
    with pytest.raises(TypeError, match=r"candidate: .* has no curves"):
        crashsim.compare(run, [1, 2, 3])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="unexpected keyword argument 'channel'; did you mean 'channels'"):
        crashsim.compare(run, run, channel="velocity_mps")  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="accel"):
        crashsim.rate(run, run, channel="acel_mps2")


def test_a_wall_is_the_command_lines(tmp_path: Path) -> None:
    told = run_program("wall", DATA / "wall" / "rows.csv", "-o", tmp_path / "wall.csv")
    wall = crashsim.read_wall(DATA / "wall" / "rows.csv")
    numbers = crashsim.wall_numbers(wall)
    for name in crashsim.WallNumbers._fields:
        assert getattr(numbers, name) == pytest.approx(math.nan if told[name] is None else told[name], nan_ok=True)
    assert wall.cells == told["cells"]
    assert np.allclose(sum(row.force_n for row in wall.rows), wall.total_force_n, rtol=ROUNDING)
    assert crashsim.check_momentum(numbers) == []
    for value in (wall, wall.rows[0], numbers):
        assert_value(value)


def test_a_wall_can_be_put_together_from_traces() -> None:
    traces = crashsim.read_traces(DATA / "wall" / "rows.csv")
    assert crashsim.wall_channels(traces) == [0, 1, 2, 3]
    wall = crashsim.assemble_wall(traces, lower_edge_m="50 mm", top_row="last")
    assert [row.height_m for row in wall.rows] == sorted(row.height_m for row in wall.rows)
    with pytest.raises(TypeError, match="did you mean 'cell_height_m'"):
        crashsim.assemble_wall(traces, cell_height=0.1)  # type: ignore[call-arg]
    assert crashsim.check_redundant(traces) == []
