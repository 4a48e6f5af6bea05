"""Joint fits, choice of a model, uncertainty and prediction from Python."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import crashsim

DATA = Path(__file__).parents[2] / "data" / "fe-car"
CHANNELS = ["LEFT_REAR_VX", "RIGHT_REAR_VX"]
FIT = {"law": "crush_damping", "starts": 4, "loss": "l2"}


@pytest.fixture(scope="module")
def pulses() -> list[crashsim.Pulse]:
    return [crashsim.read_pulse(DATA / f"C{speed}.csv", channels=CHANNELS) for speed in (40, 56)]


@pytest.fixture(scope="module")
def fit(pulses: list[crashsim.Pulse]) -> crashsim.Identification:
    return crashsim.identify(pulses, law="crush_damping", starts=4, loss="l2")


@pytest.fixture(scope="module")
def errors(pulses: list[crashsim.Pulse], fit: crashsim.Identification) -> crashsim.Uncertainty:
    return crashsim.uncertainty(pulses, fit, identify=FIT, replicates=50)


def test_a_fit_tells_of_its_tests(fit: crashsim.Identification) -> None:
    assert [round(3.6 * test.impact_speed_mps) for test in fit.tests] == [40, 56]
    assert np.isclose(np.mean([test.error.total for test in fit.tests]), fit.error.total)
    assert {number.part for number in fit.ordinates} == {"spring", "damper"}
    assert all(np.isnan(test.gain) for test in fit.tests)


def test_equation_error_is_least_squares_in_the_force(pulses: list[crashsim.Pulse]) -> None:
    pulse = pulses[1]
    fit = crashsim.equation_error(pulse, law="force", damper_knots=0, loss="l2")
    until = np.asarray(pulse.time_s) <= pulse.t_m_s
    crush, force = np.asarray(pulse.displacement_m)[until], -pulse.mass_kg * np.asarray(pulse.accel_mps2)[until]
    knots = np.asarray(fit.model.spring.knots)
    hats = np.array([np.interp(np.maximum(crush, 0.0), knots, row) for row in np.eye(len(knots))]).T
    free, *_ = np.linalg.lstsq(hats, force, rcond=None)
    assert np.all(free > 0.0), "else the bounds matter"
    np.testing.assert_allclose(fit.model.spring.ordinates, free, rtol=1e-9)


def test_errors_of_accelerometers_are_sought(pulses: list[crashsim.Pulse]) -> None:
    fit = crashsim.identify(
        pulses,
        law="crush_damping",
        starts=2,
        time_shift_deviation_s="1 ms",
        gain_deviation=0.03,
        bias_deviation_mps2=0.0,
    )
    assert all(0.8 < test.gain < 1.2 and abs(test.time_shift_s) < 5e-3 for test in fit.tests)
    assert all(0.0 < test.gain_error < 0.03 for test in fit.tests)
    assert all(np.isnan(test.bias_mps2) for test in fit.tests)


def test_uncertainty_has_intervals_replicates_and_bands(
    fit: crashsim.Identification, errors: crashsim.Uncertainty
) -> None:
    assert errors.usable
    assert [number.name for number in errors.ordinates] == [number.name for number in fit.ordinates]
    free = [number for number in errors.ordinates if number.state == "free"]
    assert free
    assert all(number.low <= number.value <= number.high for number in free)
    assert np.asarray(errors.replicates.spring_ordinates).shape == (50, 7)
    assert np.asarray(errors.covariance).shape == (14, 14)
    band = errors.spring
    assert np.all(np.asarray(band.low) <= np.asarray(band.high))
    assert len(errors.force) == 2
    assert errors.spectrum[0].words


def test_uncertainty_refuses_a_fit_of_other_options(pulses: list[crashsim.Pulse], fit: crashsim.Identification) -> None:
    with pytest.raises(crashsim.InvalidInput, match="not those of these 2 pulses and options"):
        crashsim.uncertainty(pulses, fit)


def test_predictions_have_bands_and_say_where_they_reach(
    fit: crashsim.Identification, errors: crashsim.Uncertainty
) -> None:
    prediction = crashsim.predict(fit, ["48 km/h", 20.0], uncertainty=errors)
    between, beyond = prediction.speeds
    assert prediction.replicates == 50
    assert not between.extrapolated
    assert beyond.extrapolated
    assert "faster than the speeds identified" in beyond.reasons[0]
    assert between.low.max_crush_m < between.value.max_crush_m < between.high.max_crush_m
    assert beyond.high.max_crush_m - beyond.low.max_crush_m > between.high.max_crush_m - between.low.max_crush_m
    alone = crashsim.predict(fit.model, 13.0).speeds[0]
    assert np.isnan(alone.low.max_crush_m)


def test_predictions_make_a_table(fit: crashsim.Identification, errors: crashsim.Uncertainty) -> None:
    pandas = pytest.importorskip("pandas")
    table = crashsim.predict(fit, "40km/h..56km/h:3", uncertainty=errors).to_dataframe()
    assert isinstance(table, pandas.DataFrame)
    assert list(table["impact_speed_mps"]) == pytest.approx([40 / 3.6, 48 / 3.6, 56 / 3.6])
    assert (table["max_crush_m_low"] < table["max_crush_m_high"]).all()


def test_a_model_file_predicts_what_the_program_does(program: str, tmp_path: Path) -> None:
    for speed in (40, 56):
        crashsim.write_pulse(crashsim.read_pulse(DATA / f"C{speed}.csv", channels=CHANNELS), tmp_path / f"p{speed}.csv")
    model = tmp_path / "model.json"
    given = [program, "identify", "p40.csv", "p56.csv", "--law", "crush_damping", "--starts", "4", "-o", "model.json"]
    subprocess.run([*given, "--quiet"], cwd=tmp_path, check=True)
    told = subprocess.run(
        [program, "predict", "model.json", "--speed", "48km/h", "-o", "prediction.csv", "--json"],
        cwd=tmp_path, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert json.loads(told.stdout)
    row = crashsim.predict(model, "48km/h").speeds[0]
    header, values = (
        line.split(",") for line in (tmp_path / "prediction.csv").read_text().splitlines() if not line.startswith("#")
    )
    written = dict(zip(header, values, strict=True))
    assert float(written["max_crush_m"]) == row.value.max_crush_m
    assert float(written["max_crush_m_low"]) == row.low.max_crush_m
    basis = crashsim.read_prediction_basis(model)
    assert len(basis.tests) == 2
    assert len(basis.replicates) == 200


def test_a_choice_of_models_has_a_row_each(pulses: list[crashsim.Pulse]) -> None:
    selection = crashsim.select_model(
        pulses, method="equation-error", laws=["force", "crush_damping"], spring_knots=[5.0, 7.0], damper_knots=[1.0]
    )
    assert selection.usable
    recommended = selection.recommended
    assert recommended is not None
    assert recommended.recommended
    assert len(selection.rows) >= 2
    assert all(len(row.left_out) == 2 for row in selection.rows)
    assert recommended.name in selection.recommendation
