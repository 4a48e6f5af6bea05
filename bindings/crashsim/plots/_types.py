"""What pictures need of the things they draw: results of crashsim fit, and anything else with these attributes.

A number that is not known is NaN or None.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeAlias, TypeVar

from numpy.typing import ArrayLike

T = TypeVar("T")

#: One thing, several, or several by the name that the legend shows.
OneOrMany: TypeAlias = T | Sequence[T] | Mapping[str, T]


class Motion(Protocol):
    """Crush over time from impact: `Pulse`, `CrushResponse`, `CoupledResponse`."""

    @property
    def time_s(self) -> ArrayLike: ...
    @property
    def accel_mps2(self) -> ArrayLike: ...
    @property
    def velocity_mps(self) -> ArrayLike: ...
    @property
    def displacement_m(self) -> ArrayLike: ...
    @property
    def t_m_s(self) -> float | None: ...


class MassMotion(Motion, Protocol):
    """Motion of a known mass: `Pulse`."""

    @property
    def mass_kg(self) -> float | None: ...


class SpeedMotion(Motion, Protocol):
    """Motion from a known speed: `Pulse`, `CrushResponse`, `CoupledResponse`."""

    @property
    def impact_speed_mps(self) -> float | None: ...


class ForceMotion(Motion, Protocol):
    """Motion with its forces: `CrushResponse`."""

    @property
    def spring_force_n(self) -> ArrayLike: ...
    @property
    def damper_force_n(self) -> ArrayLike: ...
    @property
    def energy_residual_j(self) -> ArrayLike: ...


class Curve(Protocol):
    """`PiecewiseLinear`."""

    @property
    def knots(self) -> ArrayLike: ...
    @property
    def ordinates(self) -> ArrayLike: ...


class Model(Protocol):
    """`CrushModel`; `law` is "stiffness", "force", "crush_damping" or "rate", or an enumerator of that name."""

    @property
    def law(self) -> object: ...
    @property
    def spring(self) -> Curve: ...
    @property
    def damper(self) -> Curve: ...


class RateModel(Model, Protocol):
    """`CrushModel` of law "rate"."""

    @property
    def rate_coefficient(self) -> float: ...
    @property
    def reference_speed_mps(self) -> float: ...
    @property
    def impact_speed_mps(self) -> float: ...


class Ordinate(Protocol):
    """`OrdinateReport`."""

    @property
    def part(self) -> str: ...
    @property
    def standard_error(self) -> float | None: ...


class Fit(Protocol):
    """`Identification`: a model and what is known of its ordinates, spring first, then damper."""

    @property
    def model(self) -> Model: ...
    @property
    def ordinates(self) -> Sequence[Ordinate]: ...


#: A model alone, or with what is known of it.
ModelOrFit: TypeAlias = Model | Fit


class Start(Protocol):
    """`StartReport`; the error of a start that failed is infinite."""

    @property
    def error(self) -> float | None: ...


class Multistart(Protocol):
    """Any identification from many starts."""

    @property
    def starts(self) -> Sequence[Start]: ...


class BodyMotion(Protocol):
    """Heave and pitch over time: `PitchResponse`, `CoupledResponse`."""

    @property
    def time_s(self) -> ArrayLike: ...
    @property
    def heave_m(self) -> ArrayLike: ...
    @property
    def heave_velocity_mps(self) -> ArrayLike: ...
    @property
    def pitch_rad(self) -> ArrayLike: ...
    @property
    def pitch_rate_radps(self) -> ArrayLike: ...


class Series(Protocol):
    """`TimeSeries`."""

    @property
    def time_s(self) -> ArrayLike: ...
    @property
    def values(self) -> ArrayLike: ...


class MeasuredBodyMotion(Protocol):
    """`MeasuredMotion`, `PitchTarget`: each channel at its own times, empty when not measured."""

    @property
    def heave_m(self) -> Series: ...
    @property
    def heave_velocity_mps(self) -> Series: ...
    @property
    def pitch_rad(self) -> Series: ...
    @property
    def pitch_rate_radps(self) -> Series: ...
