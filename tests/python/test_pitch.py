"""Heave and pitch, their forces and their identification against closed forms and the command line's numbers."""

from __future__ import annotations

import json
import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crashsim
from support import DATA, assert_value, run_program

ROUNDING = 1e-9
MASS, STIFFNESS, FORCE = 1500.0, 80e3, 12e3
FE_CAR = DATA / "fe-car" / "C56.csv"
# k1 lf = k2 lr: heave and pitch do not touch each other
BODY = crashsim.HeavePitchModel(
    mass_kg="1.5 t",
    pitch_inertia_kgm2=2500,
    front_axle_m="1200 mm",
    rear_axle_m=1.2,
    front_stiffness_n_per_m="40 kN/m",
    rear_stiffness_n_per_m=40e3,
    front_damping_ns_per_m=0,
    rear_damping_ns_per_m=0,
    force_arm_m=0,
)


def test_a_step_of_force_swings_as_the_closed_form() -> None:
    run = crashsim.simulate_pitch(BODY, ([0, 1], [FORCE, FORCE]), start="impact", end_time_s="0.4 s", dt_s=1e-3)
    omega = math.sqrt(STIFFNESS / MASS)
    assert run.usable and run.outcome == "completed"
    assert run.time_s.shape == (401,)
    np.testing.assert_allclose(run.heave_m, -FORCE / STIFFNESS * (1 - np.cos(omega * run.time_s)), atol=1e-9)
    np.testing.assert_allclose(run.pitch_rad, 0, atol=ROUNDING)
    assert run.heave_velocity_min_mps == pytest.approx(-FORCE / STIFFNESS * omega, rel=ROUNDING)
    assert "completed" in run.brief_report() or "pitch" in run.brief_report()
    assert_value(run)


def test_matrices_and_modes_are_those_of_two_oscillators() -> None:
    np.testing.assert_array_equal(BODY.mass_matrix(), [[1500, 0], [0, 2500]])
    np.testing.assert_allclose(BODY.stiffness_matrix(), [[80e3, 0], [0, 80e3 * 1.44]], rtol=ROUNDING)
    np.testing.assert_array_equal(BODY.damping_matrix(), np.zeros((2, 2)))
    assert BODY.is_dissipative()
    heave, pitch = sorted(BODY.modes(), key=lambda mode: mode.pitch_per_heave)
    assert heave.frequency_hz == pytest.approx(math.sqrt(STIFFNESS / MASS) / 2 / math.pi, rel=ROUNDING)
    assert pitch.frequency_hz == pytest.approx(math.sqrt(80e3 * 1.44 / 2500) / 2 / math.pi, rel=ROUNDING)
    assert heave.eigenvalue.imag == pytest.approx(2 * math.pi * heave.frequency_hz, rel=ROUNDING)
    assert math.isinf(pitch.pitch_per_heave)
    assert_value(heave)


def test_a_model_is_a_value_that_says_what_is_wrong() -> None:
    assert_value(BODY)
    assert math.isnan(BODY.cg_height_m)
    assert BODY.replace(cg_height_m="540 mm").replace(cg_height_m=None) == BODY
    assert BODY.replace(per_wheel=True).with_axle_values().front_stiffness_n_per_m == STIFFNESS
    with pytest.raises(crashsim.InvalidInput, match=r"HeavePitchModel.mass_kg = -3 kg: must be > 0"):
        BODY.replace(mass_kg=-3)
    with pytest.raises(TypeError, match="did you mean 'force_arm_m'"):
        BODY.replace(force_arm=1)  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="pitch_inertia_kgm2"):
        crashsim.HeavePitchModel(mass_kg=1).validate()


def test_simulate_pitch_refuses_what_is_no_force() -> None:
    with pytest.raises(TypeError, match="force: must be a TimeSeries, a Trace or a pair"):
        crashsim.simulate_pitch(BODY, 3)  # type: ignore[arg-type]
    with pytest.raises(crashsim.InvalidInput, match="force: 2 times but 3 values"):
        crashsim.simulate_pitch(BODY, ([0, 1], [1, 2, 3]), start="impact")
    with pytest.raises(TypeError, match=r"simulate_pitch.*'strat'; did you mean 'start'"):
        crashsim.simulate_pitch(BODY, ([0, 1], [1, 2]), strat="impact")  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="t_m"):
        crashsim.simulate_pitch(BODY, ([0, 1], [1, 2]))


def test_pitch_is_the_command_lines(tmp_path: Path) -> None:
    channels = {"vertical_channels": "barrier_impulse_FTZ", "velocity_channels": "LEFT_REAR_VX"}
    told = run_program(
        *("pitch", DATA / "paper" / "table1.json", "--mass", "2582kg", "--force", FE_CAR, "--force-arm", "1.7m"),
        *("--channel", "barrier_impulse_FTZ", "--velocity", "LEFT_REAR_VX", "-o", tmp_path / "pitch.csv"),
    )
    printed = json.loads((DATA / "paper" / "table1.json").read_text(encoding="utf-8"))
    known: dict[str, Any] = {name: printed[name] for name in crashsim.HeavePitchModel._fields if name in printed}
    known |= {"mass_kg": "2582 kg", "force_arm_m": "1.7 m"}
    body = crashsim.HeavePitchModel(**known)
    forcing = crashsim.read_forcing(FE_CAR, **channels)  # type: ignore[arg-type]
    run = crashsim.simulate_pitch(body, forcing)
    for name in ("outcome", "pitch_max_rad", "pitch_max_time_s", "heave_min_m", "heave_velocity_min_mps"):
        assert getattr(run, name) == told[name], name
    assert run == crashsim.simulate_pitch(body, forcing.forcing)
    for value in (forcing, forcing.forcing, forcing.forcing.vertical_force_n):
        assert_value(value)


def test_a_simulated_crush_drives_pitch_by_its_force_and_height() -> None:
    crush = crashsim.simulate(crashsim.read_model(DATA / "syn-a" / "model.json"))
    forcing = crashsim.forcing_of(crush)
    force = crush.spring_force_n + crush.damper_force_n
    np.testing.assert_allclose(forcing.longitudinal_force_n.values, force, rtol=ROUNDING, atol=1e-3)
    assert forcing.t_m_s == crush.t_m_s
    high = BODY.replace(cg_height_m=0.6, force_height_m=0.5)
    run = crashsim.simulate_pitch(high, crush)
    assert run.start_time_s == crush.t_m_s
    assert run == crashsim.simulate_pitch(high, forcing)
    lowered = crashsim.simulate_pitch(high, forcing.replace(force_height_m=([0, 1], [0.5, 0.5])), start="t_m")
    np.testing.assert_allclose(lowered.pitch_rad, run.pitch_rad, atol=1e-12)


def test_the_law_of_the_vertical_force_is_its_formula() -> None:
    law = crashsim.VerticalForceLaw(angle_rad="5 deg", angle_rate_rad_per_m=0.2, angle_start_m=0.1, friction=0.15)
    assert law.is_active() and not crashsim.VerticalForceLaw().is_active()
    assert law.vertical_ratio(0.05) == pytest.approx(math.tan(math.radians(5)), rel=ROUNDING)
    assert law.vertical_ratio(0.4) == pytest.approx(min(0.15, math.tan(math.radians(5) + 0.06)), rel=ROUNDING)
    crush = crashsim.simulate(crashsim.read_model(DATA / "syn-a" / "model.json"))
    series = crashsim.vertical_force(law, crush)
    force = crush.spring_force_n + crush.damper_force_n
    ratio = [law.vertical_ratio(x) for x in crush.displacement_m]
    np.testing.assert_allclose(series.values, force * ratio, atol=1e-3)
    assert_value(law)
    with pytest.raises(crashsim.InvalidInput, match=r"VerticalForceLaw.friction = -1: must be >= 0"):
        law.replace(friction=-1)


def test_a_twin_is_identified_again() -> None:
    truth = BODY.replace(front_damping_ns_per_m=2e3, rear_damping_ns_per_m=3e3, force_arm_m=1.1)
    pushed = ([0, 0.05, 0.1], [0, 2 * FORCE, 0])
    seen = crashsim.simulate_pitch(truth, pushed, start="impact", dt_s=2e-3)
    target = crashsim.PitchTarget(heave_m=(seen.time_s, seen.heave_m), pitch_rad=(seen.time_s, seen.pitch_rad))
    told: list[tuple[int, int]] = []
    guess = truth.replace(front_stiffness_n_per_m=60e3, rear_stiffness_n_per_m=25e3)
    options: dict[str, Any] = {
        "start": "impact",
        "free": ["front_stiffness_n_per_m", "rear_stiffness"],
        "starts": 4,
        "jobs": 1,
    }
    fit = crashsim.identify_pitch(guess, pushed, target, progress=lambda *done: told.append(done), **options)
    assert fit.usable, fit.message
    assert fit.model.front_stiffness_n_per_m == pytest.approx(40e3, rel=1e-4)
    assert fit.model.rear_stiffness_n_per_m == pytest.approx(40e3, rel=1e-4)
    assert [p.name for p in fit.parameters] == ["front_stiffness_n_per_m", "rear_stiffness_n_per_m"]
    assert fit.correlation.shape == (2, 2) and fit.verdict.identifiable
    assert all(total == 4 for _, total in told)
    assert_value(fit)


def test_threads_identify_as_one_does() -> None:
    pushed = ([0, 0.05, 0.1], [0, FORCE, 0])
    guess = BODY.replace(force_arm_m=1)
    seen = crashsim.simulate_pitch(guess, pushed, start="impact", dt_s=5e-3)
    target = crashsim.PitchTarget(heave_m=(seen.time_s, seen.heave_m), pitch_rad=(seen.time_s, seen.pitch_rad))
    free = ["front_stiffness_n_per_m", "rear_stiffness_n_per_m"]

    def fit(seed: int) -> crashsim.PitchIdentification:
        found = crashsim.identify_pitch(guess, pushed, target, start="impact", free=free, starts=5, jobs=1, seed=seed)
        return found.replace(seconds=0)

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(fit, range(8))) == [fit(seed) for seed in range(8)]


def test_what_a_progress_function_raises_or_answers_is_heeded() -> None:
    pushed = ([0, 0.05, 0.1], [0, FORCE, 0])
    time = np.linspace(0, 0.3, 31)
    target = crashsim.PitchTarget(heave_m=(time, -0.1 * time))
    guess = BODY.replace(force_arm_m=1)

    def fail(done: int, total: int) -> bool:
        raise RuntimeError(f"enough after {done} of {total}")

    options: dict[str, Any] = {"start": "impact", "starts": 100_000, "jobs": 1}
    with pytest.raises(RuntimeError, match=r"enough after \d+ of 100000"):
        crashsim.identify_pitch(guess, pushed, target, progress=fail, **options)
    stopped = crashsim.identify_pitch(guess, pushed, target, progress=lambda done, total: False, **options)
    assert stopped.outcome == "interrupted" and not stopped.usable
    with pytest.raises(TypeError, match=r"identify_pitch.*'start_s'; did you mean 'start"):
        crashsim.identify_pitch(guess, pushed, target, start_s=1)  # type: ignore[call-arg]


def test_a_law_is_identified_again() -> None:
    truth = crashsim.VerticalForceLaw(angle_rad=0.05, angle_rate_rad_per_m=0.3)
    crush = crashsim.simulate(crashsim.read_model(DATA / "syn-a" / "model.json"), to_max_crush=True, dt_s=1e-3)
    time = crush.time_s
    target = crashsim.VerticalForceTarget(
        vertical_force_n=crashsim.vertical_force(truth, crush),
        longitudinal_force_n=crashsim.forcing_of(crush).longitudinal_force_n,
        crush_m=(time, crush.displacement_m),
    )
    fit = crashsim.identify_vertical(target, free=["angle", "angle_rate"], starts=4, jobs=1)
    assert fit.usable, fit.message
    assert fit.law.angle_rad == pytest.approx(0.05, rel=1e-4)
    assert fit.law.angle_rate_rad_per_m == pytest.approx(0.3, rel=1e-4)
    for value in (fit, target):
        assert_value(value)


def test_forces_and_crush_are_read_from_one_file() -> None:
    read = crashsim.read_vertical_target(
        FE_CAR,
        vertical_channels="barrier_impulse_FTZ",
        longitudinal_channels="barrier_impulse_FTX",
        velocity_channels="LEFT_REAR_VX",
        crush_channels="LEFT_REAR_DX",
    )
    assert len(read.target.crush_m) > 100
    assert_value(read)


def test_heave_and_pitch_of_two_stations_are_the_lines_through_them() -> None:
    time = np.array([0.0, 0.1, 0.2])

    def station(position_m: float, rise: float) -> crashsim.BodyStation:
        trace = crashsim.Trace(name="z", axis="Z", dimension="length", time_s=time, values=rise * time)
        return crashsim.BodyStation(position_m=position_m, traces=[trace])

    motion = crashsim.body_motion(station(3.0, -1.0), station(1.0, 0.5), "1.8 m", "up")
    np.testing.assert_allclose(motion.pitch.values, 0.75 * time, atol=1e-15)
    np.testing.assert_allclose(motion.heave.values, -0.1 * time, atol=1e-15)
    down = crashsim.body_motion(station(3.0, -1.0), station(1.0, 0.5), 1.8, "down")
    np.testing.assert_allclose(down.pitch.values, -motion.pitch.values, atol=1e-15)
    assert_value(motion)
    with pytest.raises(crashsim.InvalidInput, match="must be ahead of the rear one"):
        crashsim.body_motion(station(1.0, 0), station(3.0, 0), 1.8)


def test_measured_motion_is_read_compared_and_identified_from(tmp_path: Path) -> None:
    damped = BODY.replace(front_damping_ns_per_m=2e3, rear_damping_ns_per_m=2e3, force_arm_m=1.0)
    pushed = ([0, 0.05, 0.1], [0, FORCE, 0])
    seen = crashsim.simulate_pitch(damped, pushed, start="impact", dt_s=1e-3)
    rows = zip(seen.time_s, seen.front_deflection_m, seen.rear_deflection_m, strict=True)
    table = "\n".join(f"{t:.17g},{front:.17g},{rear:.17g}" for t, front, rear in rows)
    (tmp_path / "motion.csv").write_text("time_s,front_m,rear_m\n" + table + "\n", encoding="utf-8")
    places = {"front_position_m": 1.2, "rear_position_m": -1.2, "cg_position_m": 0}
    motion = crashsim.read_motion(tmp_path / "motion.csv", front_channels="front_m", rear_channels=["rear_m"], **places)  # type: ignore[arg-type]
    np.testing.assert_allclose(motion.heave_m.values, seen.heave_m, atol=1e-15)
    np.testing.assert_allclose(motion.pitch_rad.values, seen.pitch_rad, atol=1e-15)
    assert len(motion.pitch_rate_radps) == 0
    compared = crashsim.compare(motion, seen)
    assert [channel.name for channel in compared.channels] == ["heave_m", "pitch_rad"]
    assert all(channel.errors.max_abs < 1e-15 for channel in compared.channels)
    fit = crashsim.identify_pitch(damped, pushed, motion, start="impact", starts=1, jobs=1, free="front_stiffness")
    assert fit.error.total == pytest.approx(0, abs=1e-9)
    assert_value(motion)
