"""Ratings, pulse metrics and sensor corrections against other hands: the package `objective-rating-metrics`, and SciPy.

script/oracles installs them into an environment of their own; tests skip without. Their scripts are in tests/oracles.
"""

from __future__ import annotations

import json
import subprocess
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import crashsim
from support import DATA, ROOT

Array = NDArray[np.float64]

PYTHON = ROOT / "build/oracles/objective-rating-metrics/bin/python"
VECTORS = ROOT.parent / "shared/oracles/oracles.json"
RATINGS = 1e-6  # regression: absolute, asked of ratings between 0 and 1
SCIPY = 2e-6  # solver: relative, of solve_ivp and quad
CORRECTIONS = 2e-3  # solver: of a standard error; where two minimisers end
DT = 1e-4
GRAVITY = 9.80665


def ask(script: str, question: object) -> Any:
    """What a script of tests/oracles answers."""
    if not PYTHON.exists():
        pytest.skip("script/oracles has not been run")
    command = [str(PYTHON), str(ROOT / "tests/oracles" / script)]
    done = subprocess.run(command, input=json.dumps(question), capture_output=True, text=True, check=True, timeout=1800)
    return json.loads(done.stdout)


def half_sine(time: Array, start: float, duration: float, height: float) -> Array:
    phase = (time - start) / duration
    return np.where((phase > 0) & (phase < 1), height * np.sin(np.pi * phase), 0.0)


def crash(time: Array, random: np.random.Generator) -> Array:
    """A pulse with the bumps of a front end: ramp, engine, firewall."""
    pulse = half_sine(time, 0.005, random.uniform(0.07, 0.12), random.uniform(-250, -150))
    for _ in range(3):
        width = random.uniform(0.008, 0.03)
        centre = random.uniform(0.01, 0.09)
        pulse += random.uniform(-150, 60) * np.exp(-(((time - centre) / width) ** 2))
    return pulse


def smooth_noise(count: int, random: np.random.Generator) -> Array:
    return np.convolve(random.normal(size=count + 20), np.full(21, 1 / 21), "valid")


def pair(seed: int) -> dict[str, Any]:
    """A test and its model: the same pulse shifted, scaled, stretched, with noise on both."""
    random = np.random.default_rng(seed)
    time = np.arange(int(random.integers(600, 1600)), dtype=np.float64) * DT
    shape = np.random.default_rng(seed + 10_000)
    moved = (time - random.uniform(-0.008, 0.008)) * random.uniform(0.93, 1.07)
    if seed % 2:
        reference, candidate = half_sine(time, 0.01, 0.1, -200), half_sine(moved, 0.01, 0.1, -200)
    else:
        reference, candidate = crash(time, shape), crash(moved, np.random.default_rng(seed + 10_000))
    noise = random.uniform(0, 30)
    return {
        "reference": (reference + noise * smooth_noise(len(time), random)).tolist(),
        "candidate": (random.uniform(0.7, 1.3) * candidate + noise * smooth_noise(len(time), random)).tolist(),
        "dt_s": DT,
    }


def test_ratings_are_those_of_objective_rating_metrics() -> None:
    pairs = [pair(seed) for seed in range(200)]
    rated = [crashsim.rate(p["reference"], p["candidate"], p["dt_s"]) for p in pairs]
    found = np.array([[getattr(rating, name) for name in crashsim.Rating._fields] for rating in rated])
    expected = np.array(ask("rate_pairs.py", pairs))
    assert np.max(np.abs(found - expected)) < RATINGS
    assert {crashsim.grade(r.overall) for r in rated} >= {"fair", "good", "excellent"}


@pytest.mark.skipif(not VECTORS.exists(), reason="the shared oracle numbers are not beside this repository")
def test_ratings_are_those_of_the_vectors() -> None:
    vectors = json.loads(VECTORS.read_text())["iso18571_halfsine20g_100ms_from_10ms_N1500_dt1e-4"]
    time = np.arange(1500, dtype=np.float64) * DT
    reference = half_sine(time, 0.01, 0.1, 20.0)
    for name, scale, shift in (("x0.9", 0.9, 0.0), ("+3ms", 1.0, 0.003), ("x0.9,+3ms", 0.9, 0.003)):
        found = crashsim.rate(reference, scale * half_sine(time, 0.01 + shift, 0.1, 20.0), DT)
        for short, score in zip(("R", "Z", "EP", "EM", "ES"), crashsim.Rating._fields, strict=True):
            assert getattr(found, score) == pytest.approx(vectors[name][short], abs=RATINGS), (name, short)
    assert crashsim.rate(reference, reference, DT).overall == vectors["same"]


def motion(seed: int) -> dict[str, Any]:
    """A pulse that stops a car within the record, at rest at its ends."""
    random = np.random.default_rng(seed)
    time = np.arange(2001, dtype=np.float64) * DT
    accel = (
        crash(time, random) * (1 - np.exp(-time / 0.002)) * np.where(time < 0.15, np.cos(np.pi * time / 0.3) ** 2, 0)
    )
    speed = -0.93 * float(np.trapezoid(accel, time))
    pulse = crashsim.make_pulse(time, accel, impact_speed_mps=speed, mass_kg=1500)
    arrays = ("time_s", "accel_mps2", "velocity_mps", "displacement_m")
    return {**{name: getattr(pulse, name).tolist() for name in arrays}, "mass_kg": 1500.0}


def test_pulse_metrics_are_those_of_scipy() -> None:
    motions = [motion(seed) for seed in range(12)]
    for m, expected in zip(motions, ask("pulse_numbers.py", motions), strict=True):
        metrics = crashsim.metrics(**m)
        olc = crashsim.occupant_load_criterion(m["time_s"], m["velocity_mps"], m["displacement_m"])
        severity = [
            crashsim.acceleration_severity_index(m["accel_mps2"], dt_s=DT, method=method)
            for method in ("moving_mean_1998", "butterworth_2010")
        ]
        found = {
            **{name: getattr(metrics, name) for name in expected if name in crashsim.Metrics._fields},
            "t1_s": olc.t1_s,
            "t2_s": olc.t2_s,
            "asi_1998": severity[0],
            "asi_2010": severity[1],
        }
        if np.isnan(found["kw400_n_per_m"]):  # there is none before 400 mm
            assert max(m["displacement_m"]) < 0.4
            del found["kw400_n_per_m"], expected["kw400_n_per_m"]
        assert found == pytest.approx(expected, rel=SCIPY)


@pytest.mark.skipif(not VECTORS.exists(), reason="the shared oracle numbers are not beside this repository")
def test_a_real_tests_metrics_are_those_of_the_vectors() -> None:
    header = ROOT.parent / "shared/data/nhtsa-10146/v10146.EV5"
    expected = json.loads(VECTORS.read_text())["camry_nhtsa10146"]["meanLR"]
    pulse = crashsim.read_pulse(header)
    found = crashsim.metrics(pulse)
    assert found.max_crush_m == pytest.approx(expected["C_m"], abs=5e-5)
    assert found.t_m_s * 1e3 == pytest.approx(expected["t_m_ms"], abs=5e-4)
    assert found.kw400_n_per_m / 1e3 == pytest.approx(expected["KW400_N_per_mm"], abs=1e-2)  # its last digit
    assert found.olc_g == pytest.approx(expected["OLC_g"], abs=5e-5)
    assert found.centroid_s * 1e3 == pytest.approx(expected["centroid_ms"], abs=1e-2)
    assert found.energy_j / 1e3 == pytest.approx(expected["KE0_kJ"], abs=5e-4)
    balance = crashsim.motion_balance(pulse)
    assert found.energy_j * balance.work_ratio / 1e3 == pytest.approx(expected["E_at_C_kJ"], abs=5e-3)
    assert crashsim.check_balance(balance) == []


def test_sensor_corrections_are_those_of_brute_force() -> None:
    traces = crashsim.read_traces(DATA / "sensors/channels.csv")
    options: dict[str, Any] = {
        "bias": "none",
        "channels": "*",
        "end_s": 0.12,
        "velocity_times_s": [0.06, 0.12],
        "velocities_mps": [6.0, -1.4],
        "velocity_sd_mps": 0.1,
    }
    found = crashsim.correct_sensors(traces, **options)
    times = traces.traces[0].time_s
    step = float(times[1] - times[0])
    question = {
        "channels": [crashsim.cfc_filter(trace.values, step, 60).tolist() for trace in traces.traces],
        "dt_s": step,
        "first_s": float(times[0]),
        "count": round(0.12 / step) + 1,
        "speed_mps": traces.impact_speed_mps,
        "noise_mps2": found.noise_mps2,
        "correlated_samples": found.correlation_time_s / step,
        "bias_sd": 2.0,
        "gain_sd": 0.02,
        "shift_sd": 1e-4,
        "velocities": [[0.06, 6.0, 0.1], [0.12, -1.4, 0.1]],
    }
    expected = ask("correct_sensors.py", question)
    errors = np.array(expected["errors"]).reshape(3, 3)
    names = ("bias_mps2", "gain", "time_shift_s")
    told = ("bias_error_mps2", "gain_error", "time_shift_error_s")
    for kind, (name, error) in enumerate(zip(names, told, strict=True)):
        for c, channel in enumerate(found.channels):
            known = expected[("bias", "gain", "shift")[kind]][c]
            assert abs(getattr(channel, name) - known) < CORRECTIONS * errors[kind, c], (name, c)
            assert getattr(channel, error) == pytest.approx(errors[kind, c], rel=CORRECTIONS)
