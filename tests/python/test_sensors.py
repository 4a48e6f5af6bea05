"""Corrections of accelerometers, balance of a motion, metrics side by side: the command line's numbers."""

from __future__ import annotations

import logging
import math
from pathlib import Path

import numpy as np
import pytest

import crashsim
from support import DATA, assert_value, run_program

CHANNELS = DATA / "sensors/channels.csv"
ROUNDING = 1e-12
TRAPEZOIDS = 1e-6


def test_a_correction_is_the_command_lines(tmp_path: Path) -> None:
    told = run_program("correct", CHANNELS, "--channel", "*", "--rebound", "-1.4m/s")
    found = crashsim.read_sensor_correction(CHANNELS, channels="*", rebound_velocity_mps="-1.4 m/s")
    assert found.usable and found.outcome == told["outcome"] == "completed"
    for channel, expected in zip(found.channels, told["channels"], strict=True):
        for name in crashsim.ChannelCorrection._fields:
            assert getattr(channel, name) == expected[name], name
    assert found.conditions[0].after_mps == told["conditions"][0]["after_mps"]
    assert list(found.by_prior) == told["by_prior"]
    for value in (found, found.channels[0], found.conditions[0]):
        assert_value(value)


def test_a_pulse_is_made_of_the_corrected_mean(tmp_path: Path) -> None:
    found = crashsim.correct_sensors(crashsim.read_traces(CHANNELS), channels="*", rebound_velocity_mps=-1.4)
    assert list(found.corrected) == ["accel_mps2", *(f"accel_{c}_mps2" for c in (2, 3, 4))]
    pulse = crashsim.make_pulse(found.corrected)
    assert pulse.mass_kg == 1500 and pulse.impact_speed_mps == 15
    assert min(pulse.velocity_mps) == pytest.approx(-1.4, abs=0.02)
    crashsim.write_sensor_correction(found, tmp_path / "corrected.csv")
    again = crashsim.read_pulse(tmp_path / "corrected.csv")
    assert np.array_equal(again.velocity_mps, pulse.velocity_mps)


def test_a_wall_is_taken() -> None:
    time = np.arange(-0.05, 0.2, 5e-4)
    wave = np.where((time > 0) & (time < 0.11), 1 - np.cos(2 * np.pi * time / 0.11), 0.0)
    wall = crashsim.LoadCellWall(time_s=time, total_force_n=1.02 * 24.6e3 / 0.11 * wave)
    found = crashsim.correct_sensors(crashsim.read_traces(CHANNELS), wall, channels="*")
    assert found.conditions[0].known_mps == pytest.approx(15 - 1.02 * 16.4, abs=1e-3)
    assert 1.0 < found.wall_gain < 1.02
    exact = crashsim.correct_sensors(crashsim.read_traces(CHANNELS), wall=wall, channels="*", wall_gain_sd=0)
    assert math.isnan(exact.wall_gain)


def test_corrections_refuse_and_warn(caplog: pytest.LogCaptureFixture) -> None:
    traces = crashsim.read_traces(CHANNELS)
    with pytest.raises(crashsim.InvalidInput, match="one channel and nothing it could be compared with"):
        crashsim.correct_sensors(traces, channels="2")
    with pytest.raises(TypeError, match="unexpected keyword argument 'gain'"):
        crashsim.correct_sensors(traces, gain=0.1)  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="velocities_mps 0: give a velocity for each"):
        crashsim.correct_sensors(traces, channels="*", velocity_times_s=[0.1])
    with caplog.at_level(logging.WARNING, logger="crashsim"):
        crashsim.correct_sensors(traces, channels="*")
    assert "compared with each other only" in caplog.text


def test_the_balance_of_a_pulse_holds_and_that_of_a_wrong_one_does_not() -> None:
    time = np.linspace(0.0, 0.12, 1201)
    pulse = crashsim.make_pulse(time, -260 * np.sin(np.pi * np.minimum(time / 0.1, 1)), impact_speed_mps=15)
    balance = crashsim.motion_balance(pulse)
    assert balance.velocity_deviation < ROUNDING
    assert balance.work_ratio == pytest.approx(1, abs=TRAPEZOIDS)
    assert crashsim.check_balance(balance) == []
    assert_value(balance)
    wrong = crashsim.motion_balance(time, 1.1 * pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m)
    assert wrong.work_ratio == pytest.approx(1.1, abs=10 * TRAPEZOIDS)
    assert "velocity is not the integral of acceleration" in crashsim.check_balance(wrong)[0]


def test_the_fleet_is_told_of_what_is_outside() -> None:
    assert crashsim.check_fleet("653 mm", 39.6) == []
    assert crashsim.check_fleet(None) == []
    assert "maximum crush 0.823 m is outside 0.442 to 0.796 m" in crashsim.check_fleet(0.823)[0]


def test_metrics_stand_side_by_side_as_on_the_command_line(tmp_path: Path) -> None:
    model = DATA / "syn-a" / "model.json"
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    run_program("simulate", model, "-o", files[0])
    run_program("simulate", model, "--speed", 15, "-o", files[1])
    told = run_program("compare", *files)["metrics"]
    compared = crashsim.compare_metrics(*[crashsim.read_traces(file) for file in files])
    assert [metric.name for metric in compared] == list(crashsim.Metrics._fields) == list(told)
    for metric in compared:
        for name in ("reference", "candidate", "difference"):
            known = told[metric.name][name]
            assert getattr(metric, name) == pytest.approx(math.nan if known is None else known, nan_ok=True)
    assert_value(compared[0])
    read = crashsim.read_model(model)
    runs = [crashsim.simulate(read), crashsim.simulate(read, impact_speed_mps=15)]
    crush = next(m for m in crashsim.compare_metrics(*runs) if m.name == "max_crush_m")
    assert crush.difference == pytest.approx(runs[1].max_crush_m / runs[0].max_crush_m - 1, rel=1e-6)
