"""Many models at once: the numbers of one at a time, arrays in and views out."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest

import crashsim
import support

RTOL = 1e-6  # of two integrators at rtol 1e-8, in the largest value
SPEEDS_MPS = np.linspace(8.0, 16.0, 5)


@pytest.fixture(scope="module")
def car() -> crashsim.CrushModel:
    return crashsim.read_model(support.DATA / "syn-a/model.json")


def sweep(car: crashsim.CrushModel, count: int = 5) -> crashsim.CrushModels:
    factors = np.linspace(0.8, 1.2, count)[:, np.newaxis]
    return crashsim.CrushModels(
        common=car,
        mass_kg=np.linspace(1000, 1600, count),
        impact_speed_mps=np.linspace(8.0, 16.0, count),
        spring_ordinates=factors * car.spring.ordinates,
        damper_ordinates=factors * car.damper.ordinates,
    )


def test_every_model_moves_as_it_does_alone(car: crashsim.CrushModel) -> None:
    models = sweep(car)
    runs = crashsim.simulate_many(models, end_time_s=0.15, dt_s=1e-3, metrics="all")
    assert len(models) == len(runs) == runs.completed == 5
    for i in range(5):
        alone = crashsim.simulate(models.model(i), end_time_s=0.15, dt_s=1e-3)
        assert runs.outcome[i] == alone.outcome
        assert np.array_equal(runs.time_s, alone.time_s)
        for name in ("accel_mps2", "velocity_mps", "displacement_m"):
            expected = getattr(alone, name)
            np.testing.assert_allclose(getattr(runs, name)[i], expected, rtol=0, atol=RTOL * np.abs(expected).max())
        assert runs.max_crush_m[i] == pytest.approx(alone.max_crush_m, rel=RTOL)
        assert runs.olc_g[i] == pytest.approx(crashsim.metrics(alone).olc_g, rel=1e-4)


def laws() -> dict[str, crashsim.CrushModel]:
    """A model of each law that knows of a rate effect."""
    spring = crashsim.PiecewiseLinear([0.0, 0.2, 0.5], [1e5, 2e5, 2.5e5])
    damper = crashsim.PiecewiseLinear([0.0, 0.3], [4e3, 1e3])
    common: dict[str, Any] = {"mass_kg": 1400.0, "spring": spring, "impact_speed_mps": 15.0}
    return {
        "crush_damping": crashsim.CrushModel(**common, law="crush_damping", damper=damper),
        "rate": crashsim.CrushModel(**common, law="rate", rate_coefficient=0.08, reference_speed_mps=1.0),
    }


@pytest.mark.parametrize("law", ["crush_damping", "rate"])
def test_models_of_every_law_move_as_they_do_alone(law: str) -> None:
    car = laws()[law]
    assert car.law == law
    support.assert_value(car)
    arrays: dict[str, Any] = {"mass_kg": [1e3, 1.3e3, 1.7e3]}
    if law == "rate":
        arrays = {"rate_coefficient": [0.0, 0.05, 0.1]}
    models = crashsim.CrushModels(common=car, **arrays)
    runs = crashsim.simulate_many(models, end_time_s=0.15, dt_s=1e-3)
    for i in range(3):
        alone = crashsim.simulate(models.model(i), end_time_s=0.15, dt_s=1e-3)
        np.testing.assert_allclose(runs.velocity_mps[i], alone.velocity_mps, rtol=0, atol=RTOL * 15.0)
        assert runs.max_crush_m[i] == pytest.approx(alone.max_crush_m, rel=RTOL)
    assert len(set(runs.max_crush_m)) == 3


def test_the_force_besides_the_springs_needs_crush_where_it_depends_on_it() -> None:
    damped, rated = laws()["crush_damping"], laws()["rate"]
    assert damped.damper_force(10.0, 0.15) == pytest.approx(2.5e4)
    np.testing.assert_allclose(damped.damper_force([10.0, -4.0], [0.0, 0.3]), [4e4, -4e3])
    np.testing.assert_allclose(damped.damper_force([10.0, -4.0], 0.3), [1e4, -4e3])
    np.testing.assert_allclose(damped.damper_force(2.0, displacement_m=[0.0, 0.3]), [8e3, 2e3])
    assert rated.damper_force(3.0, 0.2) == pytest.approx(2e5 * 0.08 * np.log(4.0))
    with pytest.raises(crashsim.InvalidInput, match="with law rate the damper's force depends on the crush, too"):
        rated.damper_force(3.0)
    with pytest.raises(crashsim.InvalidInput, match="displacement_m: has 3 values and velocity_mps has 2"):
        damped.damper_force([1.0, 2.0], [0.1, 0.2, 0.3])


def test_results_are_views_of_the_engines_memory(car: crashsim.CrushModel) -> None:
    runs = crashsim.simulate_many(sweep(car), dt_s=1e-3)
    assert runs.accel_mps2.shape == (5, 201)
    assert all(array.base is runs for array in (runs.time_s, runs.accel_mps2, runs.max_crush_m))  # type: ignore[comparison-overlap]
    assert runs.max_crush_m.strides == runs.t_m_s.strides and runs.max_crush_m.strides[0] > 8
    assert list(runs.outcome) == ["completed"] * 5
    velocity, crush = runs.velocity_mps, runs.max_crush_m
    expected = (velocity.copy(), crush.copy())
    del runs
    assert np.array_equal(velocity, expected[0]) and np.array_equal(crush, expected[1])


def test_models_and_responses_are_values(car: crashsim.CrushModel) -> None:
    models = sweep(car)
    runs = crashsim.simulate_many(models, dt_s=1e-3)
    for value in (models, runs, crashsim.simulate_many(models, samples=False), crashsim.CrushModels(common=car)):
        support.assert_value(value)
    assert "outcome=array of 5, t_m_s=array of 5" in repr(runs) and "accel_mps2=array of 5 x 201" in repr(runs)
    with pytest.raises(crashsim.InvalidInput, match=r"CrushResponses.max_crush_m: has 1 values, another array has 2"):
        crashsim.CrushResponses(t_m_s=[0.1, 0.2], max_crush_m=[0.3])


def test_a_table_has_a_row_for_each_model(car: crashsim.CrushModel) -> None:
    pytest.importorskip("pandas")
    runs = crashsim.simulate_many(sweep(car), samples=False)
    assert runs.accel_mps2.size == 0
    frame = runs.to_dataframe()
    assert list(frame)[:3] == ["outcome", "t_m_s", "max_crush_m"] and len(frame) == 5 and "time_s" not in frame
    assert np.array_equal(frame["max_crush_m"], runs.max_crush_m)


def test_one_model_needs_no_arrays(car: crashsim.CrushModel) -> None:
    models = crashsim.CrushModels(common=car.replace(impact_speed_mps=12.0))
    assert len(models) == 1 and crashsim.simulate_many(models).displacement_m.shape == (1, 2001)


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"mass_kg": [1000.0, 1200.0], "impact_speed_mps": [10.0]}, "impact_speed_mps"),
        ({"mass_kg": [1000.0, -1.0], "impact_speed_mps": [10.0, 11.0]}, r"mass_kg.*-1"),
        ({"impact_speed_mps": [10.0], "spring_ordinates": [[1e5, 2e5]]}, "spring_ordinates"),
        ({"mass_kg": [[1000.0]]}, r"CrushModels.mass_kg: must be one-dimensional, its shape is \(1, 1\)"),
        ({"spring_ordinates": [1e5]}, r"CrushModels.spring_ordinates: must be two-dimensional, its shape is \(1,\)"),
    ],
)
def test_arrays_that_do_not_fit_are_named(car: crashsim.CrushModel, arrays: Any, message: str) -> None:
    with pytest.raises(crashsim.InvalidInput, match=message):
        crashsim.simulate_many(crashsim.CrushModels(common=car, **arrays))


def test_wrong_words_are_explained(car: crashsim.CrushModel) -> None:
    models = crashsim.CrushModels(common=car, impact_speed_mps=SPEEDS_MPS)
    with pytest.raises(TypeError, match="unexpected keyword argument 'sample'; did you mean 'samples'"):
        crashsim.simulate_many(models, sample=True)  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="rtol"):
        crashsim.simulate_many(models, rtol=2.0)
    with pytest.raises(TypeError, match="must be an array of real numbers"):
        crashsim.CrushModels(spring_ordinates=[["a"]])
    with pytest.raises(crashsim.InvalidInput, match="5"):
        models.model(5)


def test_other_threads_go_on_meanwhile(car: crashsim.CrushModel) -> None:
    ticks, done = 0, threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(1e-3)

    models = sweep(car, 20_000)
    clock = threading.Thread(target=tick)
    clock.start()
    before = ticks
    crashsim.simulate_many(models, samples=False, jobs=1)
    during = ticks - before
    done.set()
    clock.join()
    assert during >= 2  # 0 or 1 when the interpreter is held
