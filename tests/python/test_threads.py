"""Python threads: every long call gives in eight threads at once what it gives alone."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import crashsim

THREADS = 8
SPEEDS_MPS = np.linspace(11.0, 16.0, THREADS)


def model() -> Any:
    spring = crashsim.PiecewiseLinear([0.0, 0.2, 0.4, 0.8], [9e5, 5e5, 4e5, 8e5])
    damper = crashsim.PiecewiseLinear([0.0, 8.0, 16.0], [1.2e4, 6e3, 3e3])
    return crashsim.CrushModel(1200.0, spring=spring, damper=damper)


def pulse(speed_mps: float) -> Any:
    run = crashsim.simulate(model(), impact_speed_mps=speed_mps, end_time_s=0.12, dt_s=2e-4)
    ripple = 1.0 + 0.02 * np.sin(900.0 * run.time_s)
    return crashsim.make_pulse(run.time_s, ripple * run.accel_mps2, impact_speed_mps=speed_mps, mass_kg=1200.0)


def fitted(speed_mps: float, **options: Any) -> bytes:
    """Everything that an identification finds, bit for bit."""
    fit = crashsim.identify(pulse(speed_mps), spring_knots=4, damper_knots=3, **options)
    assert fit.usable, fit.message
    errors = [fit.error.total, fit.error.accel, fit.error.velocity, fit.error.displacement]
    numbers = [*fit.model.spring.ordinates, *fit.model.damper.ordinates, *errors, *(s.error for s in fit.starts)]
    spread = [row.standard_error for row in fit.ordinates]
    return np.array([*numbers, *spread, fit.starts_at_best, fit.evaluations]).tobytes()


def simulated(speed_mps: float) -> bytes:
    run = crashsim.simulate(model(), impact_speed_mps=speed_mps)
    return np.concatenate((run.time_s, run.accel_mps2, run.displacement_m, run.energy_residual_j)).tobytes()


def signals(speed_mps: float) -> bytes:
    made = pulse(speed_mps)
    filtered = crashsim.cfc_filter(made.accel_mps2, 2e-4, 60)
    return np.concatenate((made.velocity_mps, filtered, crashsim.integrate(made.time_s, filtered))).tobytes()


WORK: dict[str, Callable[[float], bytes]] = {
    "identify, one job each": lambda speed_mps: fitted(speed_mps, starts=6, jobs=1),
    "identify, two jobs each": lambda speed_mps: fitted(speed_mps, starts=6, jobs=2),
    "simulate": simulated,
    "signals": signals,
}


@pytest.mark.parametrize("name", WORK)
def test_eight_threads_at_once_give_the_serial_answers(name: str) -> None:
    alone = [WORK[name](speed_mps) for speed_mps in SPEEDS_MPS]
    gate = threading.Barrier(THREADS)

    def together(speed_mps: float) -> bytes:
        gate.wait()
        return WORK[name](speed_mps)

    with ThreadPoolExecutor(THREADS) as pool:
        assert list(pool.map(together, SPEEDS_MPS)) == alone


def test_one_pulse_and_one_model_can_be_shared() -> None:
    shared, car = pulse(14.0), model()
    alone = crashsim.identify(shared, starts=4, jobs=1)
    with ThreadPoolExecutor(THREADS) as pool:
        fits = list(pool.map(lambda _: crashsim.identify(shared, starts=4, jobs=1), range(THREADS)))
        runs = list(pool.map(lambda _: crashsim.simulate(car, impact_speed_mps=14.0), range(THREADS)))
    assert all(fit.model == alone.model and fit.error == alone.error for fit in fits)
    assert all(run.max_crush_m == runs[0].max_crush_m for run in runs)


def test_other_threads_go_on_meanwhile() -> None:
    ticks, done = 0, threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(1e-3)

    clock = threading.Thread(target=tick)
    clock.start()
    before = ticks
    crashsim.identify(pulse(15.0), starts=60, jobs=1)
    during = ticks - before
    done.set()
    clock.join()
    assert during >= 5  # 1 or 2 when the interpreter is held
