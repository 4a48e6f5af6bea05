"""Things to draw, and what was drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, TypeAlias

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]

NAN = math.nan
MASS_KG = 1200.0


@pytest.fixture
def closed_figures() -> Iterator[None]:
    """Figures are drawn without a screen, and closed when the test is over."""
    matplotlib.use("Agg")
    yield
    plt.close("all")


def crush(speed_mps: float = 15.0, omega: float = 17.0, **other: Any) -> Any:
    """Half of it spring, half damper force, of a sine of crush; t_m at a quarter of its period."""
    time_s = np.arange(0.0, 0.1201, 1e-4)
    displacement_m = speed_mps / omega * np.sin(omega * time_s)
    accel_mps2 = -speed_mps * omega * np.sin(omega * time_s)
    half_force_n = -MASS_KG * accel_mps2 / 2
    attributes = {
        "time_s": time_s,
        "accel_mps2": accel_mps2,
        "velocity_mps": speed_mps * np.cos(omega * time_s),
        "displacement_m": displacement_m,
        "spring_force_n": half_force_n,
        "damper_force_n": half_force_n,
        "energy_residual_j": np.full_like(time_s, 2e-5),
        "impact_speed_mps": speed_mps,
        "t_m_s": math.pi / 2 / omega,
        "mass_kg": MASS_KG,
    }
    return SimpleNamespace(**{**attributes, **other})


def unfinished() -> Any:
    """A motion that nothing was computed of."""
    arrays = ("time_s", "accel_mps2", "velocity_mps", "displacement_m", "spring_force_n", "damper_force_n")
    empty = {name: np.empty(0) for name in (*arrays, "energy_residual_j")}
    return SimpleNamespace(**empty, impact_speed_mps=15.0, t_m_s=NAN, mass_kg=NAN)


def model(law: object = "stiffness", scale: float = 1.0) -> Any:
    spring = SimpleNamespace(knots=[0.0, 0.3, 0.6], ordinates=[scale * 8e5, scale * 5e5, scale * 6e5])
    damper = SimpleNamespace(knots=[0.0, 15.0], ordinates=[scale * 9e3, scale * 2e3])
    return SimpleNamespace(law=law, spring=spring, damper=damper)


def rated(coefficient: float = 0.1, reference_speed_mps: float = 2.0) -> Any:
    spring = SimpleNamespace(knots=[0.0, 0.3, 0.6], ordinates=[1e5, 2e5, 2e5])
    none = SimpleNamespace(knots=[], ordinates=[])
    rate = {"rate_coefficient": coefficient, "reference_speed_mps": reference_speed_mps}
    return SimpleNamespace(law="rate", spring=spring, damper=none, impact_speed_mps=15.0, **rate)


def fit() -> Any:
    errors = {"spring": [4e4, 2e4, NAN], "damper": [1e3, 3e3]}
    starts = [0.03, 0.5, math.inf, 0.03001, 0.031, 0.03]
    return SimpleNamespace(
        model=model(),
        ordinates=[SimpleNamespace(part=part, standard_error=error) for part in errors for error in errors[part]],
        starts=[SimpleNamespace(error=error) for error in starts],
    )


def starts(*errors: float) -> Any:
    return SimpleNamespace(starts=[SimpleNamespace(error=error) for error in errors])


def body(**other: Any) -> Any:
    time_s = np.linspace(0.0, 0.3, 301)
    names = ("heave_m", "heave_velocity_mps", "pitch_rad", "pitch_rate_radps")
    channels = {name: (i + 1) * 0.01 * np.sin(12 * time_s) for i, name in enumerate(names)}
    return SimpleNamespace(time_s=time_s, **{**channels, **other})


def measured() -> Any:
    series = SimpleNamespace(time_s=np.array([0.0, 0.1, 0.2, 0.5]), values=np.array([0.0, 0.1, 0.2, 0.5]))
    empty = SimpleNamespace(time_s=np.empty(0), values=np.empty(0))
    return SimpleNamespace(heave_m=empty, pitch_rad=series, heave_velocity_mps=empty, pitch_rate_radps=empty)


def line(ax: Axes, label: str) -> tuple[Floats, Floats]:
    (found,) = [drawn for drawn in ax.get_lines() if drawn.get_label() == label]
    return np.asarray(found.get_xdata()), np.asarray(found.get_ydata())


def outline(ax: Axes) -> Floats:
    """Corners of the first area."""
    return np.asarray(ax.collections[0].get_paths()[0].vertices, dtype=np.float64)


def legend(ax: Axes) -> list[str]:
    shown = ax.get_legend()
    return [] if shown is None else [text.get_text() for text in shown.get_texts()]


def labels(ax: Axes) -> tuple[str, str]:
    return ax.get_xlabel(), ax.get_ylabel()
