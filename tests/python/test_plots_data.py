"""Pictures show the right data with the right labels and units."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from crashsim import plots
from plot_samples import (
    MASS_KG,
    NAN,
    body,
    crush,
    fit,
    labels,
    legend,
    line,
    measured,
    model,
    outline,
    rated,
    starts,
    unfinished,
)
from plot_samples import closed_figures as closed_figures

pytestmark = pytest.mark.usefixtures("closed_figures")

G = 9.80665
PARAMETERS = np.array([[1.0, 20.0], [2.0, 10.0], [4.0, 40.0]])
VALUES = np.array([1.0, 2.0, 3.0, 4.0])


def test_pulse_is_drawn_in_practical_units() -> None:
    pulse = crush()
    accel, velocity, displacement = plots.plot_pulse(pulse)
    assert [labels(ax)[1] for ax in (accel, velocity, displacement)] == [
        "acceleration [g]",
        "velocity [km/h]",
        "crush [mm]",
    ]
    assert labels(displacement)[0] == "time [ms]"
    for ax, expected in (
        (accel, pulse.accel_mps2 / G),
        (velocity, 3.6 * pulse.velocity_mps),
        (displacement, 1e3 * pulse.displacement_m),
    ):
        x, y = line(ax, "pulse")
        np.testing.assert_allclose(x, 1e3 * pulse.time_s)
        np.testing.assert_allclose(y, expected)
    assert legend(accel) == ["pulse", "$t_m$ = 92.4 ms"]
    np.testing.assert_allclose(line(accel, "$t_m$ = 92.4 ms")[0], [1e3 * pulse.t_m_s] * 2)


def test_pulse_in_metres_per_second_up_to_a_time() -> None:
    pulse = crush()
    axes = plots.plot_pulse({"test 1": pulse}, speed_unit="m/s", end_time_s=0.05)
    assert axes[1].get_ylabel() == "velocity [m/s]"
    x, y = line(axes[1], "test 1")
    assert x[-1] == pytest.approx(50.0)
    np.testing.assert_array_equal(y, pulse.velocity_mps[: len(y)])


def test_several_pulses_are_numbered_and_drawn_differently() -> None:
    accel = plots.plot_pulse([crush(), crush(10.0, t_m_s=NAN)])[0]
    assert legend(accel) == ["pulse 1", "$t_m$ of pulse 1 = 92.4 ms", "pulse 2"]
    drawn = [each for each in accel.get_lines() if each.get_label() in ("pulse 1", "pulse 2")]
    assert len({each.get_color() for each in drawn}) == len({each.get_linestyle() for each in drawn}) == 2


def test_fit_ends_a_quarter_beyond_t_m_of_the_test() -> None:
    test = crush(omega=20.0)
    axes = plots.plot_fit(test, {"model A": crush(14.0), "model B": crush(13.0)})
    assert legend(axes[0]) == ["test", "model A", "model B", "$t_m$ = 78.5 ms"]
    for label in ("test", "model A", "model B"):
        assert line(axes[2], label)[0][-1] == pytest.approx(1.25e3 * test.t_m_s, abs=0.1)
    assert line(plots.plot_fit(test, crush(), end_time_s=0.02)[0], "model")[0][-1] == pytest.approx(20.0)


def test_response_is_a_pulse_or_an_overlay() -> None:
    assert legend(plots.plot_response(crush(t_m_s=NAN))[0]) == ["model"]
    assert legend(plots.plot_response({"A": crush(14.0)}, against=crush())[0]) == ["test", "A", "$t_m$ = 92.4 ms"]


def test_model_is_spring_and_damper() -> None:
    spring, damper = plots.plot_model({"A": model(), "B": model(scale=2.0)}, title="Two models")
    assert labels(spring) == ("crush [mm]", "stiffness k [kN/m]")
    assert labels(damper) == ("velocity [m/s]", "damping c [kN s/m]")
    np.testing.assert_allclose(line(damper, "B"), [[0.0, 15.0], [18.0, 4.0]])
    assert legend(spring) == legend(damper) == ["A", "B"]
    assert (spring.get_title(loc="left"), damper.get_title(loc="left")) == ("Two models", "")


def test_unset_time_of_maximum_crush_is_not_drawn() -> None:
    for t_m_s in (NAN, None):
        motion = crush(t_m_s=t_m_s)
        assert legend(plots.plot_pulse(motion)[0]) == ["pulse"]
        axes = plots.plot_fit(motion, motion)
        assert legend(axes[0]) == ["test", "model"]
        assert line(axes[0], "model")[0][-1] == pytest.approx(120.0)
        assert legend(plots.plot_prediction([motion])) == []
        assert len(line(plots.plot_force_crush(motion, motion), "model")[0]) == len(motion.time_s)
        assert not any("t_m" in text for text in legend(plots.plot_energy(motion, MASS_KG)))


def test_nothing_computed_is_nothing_drawn() -> None:
    nothing = unfinished()
    assert all(len(line(ax, "pulse")[0]) == 0 for ax in plots.plot_pulse(nothing))
    plots.plot_fit(nothing, nothing)[0].figure.canvas.draw()
    plots.plot_energy(nothing, MASS_KG).figure.canvas.draw()
    plots.plot_force_crush(None, nothing).figure.canvas.draw()
    plots.plot_prediction([nothing]).figure.canvas.draw()
    plots.plot_starts(starts()).figure.canvas.draw()
    failed = plots.plot_starts(starts(math.inf, math.inf, math.inf))
    failed.figure.canvas.draw()
    assert legend(failed) == ["within 0.1 % of best: 0", "failed: 3"]
    plots.plot_start_parameters(np.empty((0, 3)), []).figure.canvas.draw()


def test_prediction_is_coloured_by_speed() -> None:
    slow, fast = crush(9.0), crush(12.0, t_m_s=NAN)
    ax = plots.plot_prediction([fast, slow], channel="displacement_m")
    first, dot, second = [drawn for drawn in ax.get_lines() if len(np.asarray(drawn.get_xdata()))]
    np.testing.assert_allclose(np.asarray(first.get_ydata()), 1e3 * slow.displacement_m)
    np.testing.assert_allclose(np.asarray(second.get_ydata()), 1e3 * fast.displacement_m)
    np.testing.assert_allclose(np.asarray(dot.get_xdata()), 1e3 * slow.t_m_s)
    np.testing.assert_allclose(np.asarray(dot.get_ydata()), 1e3 * slow.displacement_m.max(), rtol=1e-6)
    assert not np.array_equal(first.get_color(), second.get_color())
    assert labels(ax) == ("time [ms]", "crush [mm]")
    (bar,) = ax.child_axes
    assert bar.get_ylabel() == "impact speed [km/h]"
    np.testing.assert_allclose(bar.get_yticks(), [32.4, 43.2])
    assert [text.get_text() for text in bar.get_yticklabels()] == ["32.4", "43.2"]


def test_speeds_that_lie_close_are_not_all_labelled() -> None:
    (bar,) = plots.plot_prediction([crush(8.0), crush(12.0), crush(12.1)]).child_axes
    assert len(bar.get_yticks()) > 3


def test_prediction_needs_speeds() -> None:
    with pytest.raises(ValueError, match=r"responses: none given"):
        plots.plot_prediction([])
    with pytest.raises(ValueError, match=r"responses\[1\]\.impact_speed_mps: unset"):
        plots.plot_prediction([crush(), crush(impact_speed_mps=NAN)])


def test_spring_shows_knots_and_standard_errors() -> None:
    ax = plots.plot_spring(fit())
    assert labels(ax) == ("crush [mm]", "stiffness k [kN/m]")
    x, y = line(ax, "spring")
    np.testing.assert_allclose(x, [0.0, 300.0, 600.0])
    np.testing.assert_allclose(y, [800.0, 500.0, 600.0])
    assert legend(ax) == ["spring", "standard error"]
    band = outline(ax)
    assert band[:, 1].min() == pytest.approx(480.0)
    assert band[:, 1].max() == pytest.approx(840.0)
    assert band[:, 0].max() == pytest.approx(300.0)  # the third is unknown


def test_standard_errors_can_be_given_and_end_at_zero() -> None:
    ax = plots.plot_damper(model(), standard_error=[1e3, 5e3])
    band = outline(ax)
    assert band[:, 1].min() == 0.0
    assert band[:, 1].max() == pytest.approx(10.0)
    assert labels(ax) == ("velocity [m/s]", "damping c [kN s/m]")
    with pytest.raises(ValueError, match="standard_error: has 1 values and ordinates has 2, must be as many"):
        plots.plot_damper(model(), standard_error=[1e3])
    with pytest.raises(ValueError, match="standard_error: given for 2 models"):
        plots.plot_damper([model(), model()], standard_error=[1e3, 5e3])


def test_law_names_the_axis_and_must_be_one() -> None:
    assert plots.plot_spring(model(SimpleNamespace(name="force"))).get_ylabel() == "spring force f [kN]"
    with pytest.raises(ValueError, match="law = force, stiffness: must be one for all models"):
        plots.plot_spring([model(), model("force")])


def test_a_damper_over_crush_is_drawn_over_crush() -> None:
    ax = plots.plot_damper(model("crush_damping"))
    assert labels(ax) == ("crush [mm]", "damping c [kN s/m]")
    np.testing.assert_allclose(line(ax, "damper")[0], [0.0, 15e3])
    assert plots.plot_spring([model("force"), model("crush_damping")]).get_ylabel() == "spring force f [kN]"
    with pytest.raises(ValueError, match="law = crush_damping, force: must be one for all models"):
        plots.plot_damper([model("force"), model("crush_damping")])
    with pytest.raises(ValueError, match="law = other: must be one for all models"):
        plots.plot_damper(model("other"))


def test_a_rate_is_drawn_as_the_factor_of_the_force() -> None:
    spring, rate = plots.plot_model(rated())
    assert labels(spring) == ("crush [mm]", "spring force f [kN]")
    assert labels(rate) == ("velocity [m/s]", "rate factor 1 + r ln(1 + |v|/v_ref)")
    x, y = line(rate, "damper")
    assert x[-1] == 15.0
    np.testing.assert_allclose(y, 1.0 + 0.1 * np.log1p(x / 2.0))
    band = outline(plots.plot_damper(rated(), standard_error=[0.02]))
    assert band[:, 1].max() == pytest.approx(1.0 + 0.12 * np.log1p(7.5))


def test_curve_of_one_knot_is_a_level() -> None:
    constant = model()
    constant.spring = SimpleNamespace(knots=[0.0], ordinates=[5e5])
    level = plots.plot_spring(constant).get_lines()[0]
    assert list(np.asarray(level.get_ydata())) == [500.0, 500.0]


def test_model_without_a_spring_has_none_drawn() -> None:
    damped = model()
    damped.spring = SimpleNamespace(knots=[], ordinates=[])
    spring, damper = plots.plot_model({"A": damped})
    assert line(spring, "A")[0].size == 0
    assert line(damper, "A")[0].size == 2


def test_force_over_crush_ends_at_maximum_crush() -> None:
    test = crush()
    ax = plots.plot_force_crush(test, crush())
    assert labels(ax) == ("crush [mm]", "force [kN]")
    assert legend(ax) == ["test, $-m\\,a$", "model", "spring", "damper"]
    x, y = line(ax, "test, $-m\\,a$")
    count = int(np.sum(test.time_s <= test.t_m_s))
    np.testing.assert_allclose(x, 1e3 * test.displacement_m[:count])
    np.testing.assert_allclose(y, -1e-3 * MASS_KG * test.accel_mps2[:count])
    np.testing.assert_allclose(line(ax, "model")[1], y)
    np.testing.assert_allclose(line(ax, "spring")[1] + line(ax, "damper")[1], y)


def test_force_over_crush_of_several_models_or_the_test_alone() -> None:
    several = plots.plot_force_crush(None, {"A": crush(), "B": crush(14.0)})
    assert legend(several) == ["A", "B"]
    alone = plots.plot_force_crush(crush(mass_kg=NAN), mass_kg=2 * MASS_KG, end_time_s=0.01)
    assert len(np.asarray(alone.get_lines()[0].get_xdata())) == 101
    with pytest.raises(ValueError, match=r"test\.mass_kg: unset, .* give mass_kg="):
        plots.plot_force_crush(crush(mass_kg=NAN))
    with pytest.raises(ValueError, match="neither is given"):
        plots.plot_force_crush(None)


def test_energy_ledger_adds_up() -> None:
    ax = plots.plot_energy(crush(), MASS_KG)
    initial_kj = 1e-3 * MASS_KG * 15.0**2 / 2
    names = ["sum", "kinetic", "spring", "damper", "residual \u2264 2e-05 J", "$t_m$ = 92.4 ms"]
    assert legend(ax) == names
    total, kinetic, spring, damper, residual = (line(ax, name)[1] for name in names[:-1])
    np.testing.assert_allclose(total, initial_kj, rtol=1e-5)
    np.testing.assert_allclose(kinetic + spring + damper, total)
    np.testing.assert_allclose(spring, damper)
    assert kinetic[0] == pytest.approx(initial_kj)
    np.testing.assert_allclose(residual, 2e-8)
    assert labels(ax) == ("time [ms]", "energy [kJ]")
    with pytest.raises(ValueError, match=r"mass_kg = nan kg: must be > 0"):
        plots.plot_energy(crush(), NAN)


def test_pitch_with_what_was_measured() -> None:
    motion = body(t_m_s=0.09)
    heave, pitch = plots.plot_pitch(motion, measured=measured())
    assert legend(heave) == ["model", "$t_m$ of model = 90.0 ms"]
    assert heave.get_ylabel() == "heave [mm]"
    assert labels(pitch) == ("time [ms]", "pitch, nose down [deg]")
    np.testing.assert_allclose(line(heave, "model")[1], 1e3 * motion.heave_m)
    np.testing.assert_allclose(line(pitch, "model")[1], np.rad2deg(motion.pitch_rad))
    x, y = line(pitch, "measured")
    np.testing.assert_allclose(x, [0.0, 100.0, 200.0])  # not beyond the simulation
    np.testing.assert_allclose(y, np.rad2deg([0.0, 0.1, 0.2]))


def test_pitch_of_other_channels_and_several_models() -> None:
    channels = ("heave_velocity_mps", "pitch_rate_radps", "pitch_rad")
    axes = plots.plot_pitch({"two phases": body(), "coupled": body(t_m_s=NAN)}, channels=channels, end_time_s=0.1)
    assert [ax.get_ylabel() for ax in axes] == [
        "heave velocity [m/s]",
        "pitch rate [deg/s]",
        "pitch, nose down [deg]",
    ]
    assert legend(axes[0]) == ["two phases", "coupled"]
    assert line(axes[2], "coupled")[0][-1] == pytest.approx(100.0)
    with pytest.raises(ValueError, match="quantity = 'roll_rad': must be one of accel_mps2,"):
        plots.plot_pitch(body(), channels=["roll_rad"])


def test_starts_are_sorted_and_the_best_ones_stand_out() -> None:
    ax = plots.plot_starts(fit())
    assert legend(ax) == ["within 0.1 % of best: 3", "others: 2", "failed: 1"]
    np.testing.assert_array_equal(line(ax, "within 0.1 % of best: 3"), [[1, 2, 3], [0.03, 0.03, 0.03001]])
    np.testing.assert_array_equal(line(ax, "others: 2"), [[4, 5], [0.031, 0.5]])
    assert labels(ax) == ("start, sorted by error", "error E")
    assert ax.get_yscale() == "log"


def test_perfect_fits_are_drawn_on_a_linear_scale() -> None:
    assert plots.plot_starts(starts(0.0)).get_yscale() == "linear"


def test_parameters_of_starts_are_scaled() -> None:
    ax = plots.plot_start_parameters(PARAMETERS, [0.3, 0.1, math.inf], names=["k1", "c1"])
    assert [text.get_text() for text in ax.get_xticklabels()] == ["k1", "c1"]
    dots = np.asarray(ax.collections[0].get_offsets())
    np.testing.assert_allclose(dots[:, 1], [0.5, 1.0, 1.0, 0.5])  # worst start first
    (bar,) = ax.child_axes
    assert bar.get_ylabel() == "error E"
    scaled = plots.plot_start_parameters(PARAMETERS, [0.3, 0.1, 0.0], scale=[4.0, 80.0])
    assert np.asarray(scaled.collections[0].get_offsets())[:, 1].max() == 1.0
    assert [text.get_text() for text in scaled.get_xticklabels()] == ["p1", "p2"]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"parameters": PARAMETERS, "errors": [0.1]}, r"parameters: has shape \(3, 2\), must have a row for each of"),
        ({"parameters": [1.0, 2.0], "errors": [1.0, 2.0]}, r"parameters: has shape \(2,\)"),
        ({"parameters": PARAMETERS, "errors": VALUES[:3], "names": ["k1"]}, "names: 1 given"),
        ({"parameters": PARAMETERS, "errors": VALUES[:3], "scale": [1.0]}, "scale: has 1 values"),
    ],
)
def test_parameters_of_starts_must_agree(arguments: dict[str, Any], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        plots.plot_start_parameters(**arguments)


def test_profile_shades_what_is_plausible() -> None:
    ax = plots.plot_profile_likelihood(
        [1.0, 2.0, 3.0, 4.0], [0.05, 0.03, 0.03, 0.07], best=2.5, threshold=0.04, label="k3 [kN/m]"
    )
    np.testing.assert_array_equal(line(ax, "profile"), [[1.0, 2.0, 3.0, 4.0], [0.05, 0.03, 0.03, 0.07]])
    assert legend(ax) == ["profile", "threshold", "plausible", "best fit"]
    assert labels(ax) == ("k3 [kN/m]", "error E")
    shaded = outline(ax)[:, 0]
    assert (shaded.min(), shaded.max()) == (pytest.approx(1.5), pytest.approx(3.25))


def test_profile_with_gaps_and_without_marks() -> None:
    ax = plots.plot_profile_likelihood([1.0, 2.0, 3.0], [0.05, math.inf, 0.04], best=NAN, threshold=None)
    np.testing.assert_array_equal(line(ax, "profile")[1], [0.05, NAN, 0.04])
    assert legend(ax) == ["profile"]
    with pytest.raises(ValueError, match="errors: has 1 values and values has 2, must be as many"):
        plots.plot_profile_likelihood([1.0, 2.0], [0.1])
    with pytest.raises(ValueError, match="values: must increase strictly"):
        plots.plot_profile_likelihood([2.0, 1.0], [0.1, 0.2])


def test_work_and_precision_are_logarithmic() -> None:
    engines = {"cvode": ([1e-3, 1e-6, 0.0, NAN], [1e-5, 1e-4, 1e-3, 1e-2]), "taylor": ([1e-9], [2e-5])}
    ax = plots.plot_work_precision(engines)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert labels(ax) == ("error achieved", "time [ms]")
    assert legend(ax) == ["cvode", "taylor"]
    np.testing.assert_allclose(line(ax, "cvode"), [[1e-3, 1e-6], [1e-2, 1e-1]])
    with pytest.raises(ValueError, match="seconds of cvode: has 1 values and errors of cvode has 2"):
        plots.plot_work_precision({"cvode": ([1e-3, 1e-6], [1e-5])})
    with pytest.raises(ValueError, match="engines: none given"):
        plots.plot_work_precision({})


@pytest.mark.parametrize(
    "draw",
    [
        lambda motion: plots.plot_pulse(motion),
        lambda motion: plots.plot_fit(crush(), motion),
        lambda motion: plots.plot_prediction([motion]),
        lambda motion: plots.plot_force_crush(motion),
        lambda motion: plots.plot_energy(motion, MASS_KG),
    ],
)
def test_lengths_must_agree(draw: Callable[[Any], Any]) -> None:
    with pytest.raises(ValueError, match=r"accel_mps2: has 2 values and time_s has 1201|damper_force_n: has 2"):
        draw(crush(accel_mps2=[1.0, 2.0], damper_force_n=[1.0, 2.0]))
    with pytest.raises(ValueError, match=r"has shape \(1, 1201\), must be one-dimensional"):
        time_s = crush().time_s
        draw(crush(accel_mps2=time_s[np.newaxis], damper_force_n=time_s[np.newaxis]))


def test_figure_is_closed_when_drawing_fails() -> None:
    with pytest.raises(ValueError, match="accel_mps2: has 2 values"):
        plots.plot_pulse(crush(accel_mps2=[1.0, 2.0]))
    assert plt.get_fignums() == []


def test_nothing_to_draw_is_an_error() -> None:
    with pytest.raises(ValueError, match="pulse: none given, need at least one"):
        plots.plot_pulse([])
    with pytest.raises(ValueError, match="speed_unit = 'mph': must be 'km/h' or 'm/s'"):
        plots.plot_pulse(crush(), speed_unit="mph")  # type: ignore[arg-type]
