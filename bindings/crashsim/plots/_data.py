"""Arrays, names and units of what is drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._types import OneOrMany

T = TypeVar("T")
Floats: TypeAlias = NDArray[np.float64]
SpeedUnit: TypeAlias = Literal["km/h", "m/s"]

STANDARD_GRAVITY_MPS2 = 9.80665
MS_PER_S = MM_PER_M = 1e3
TIME_LABEL = "time [ms]"
CRUSH_LABEL = "crush [mm]"


class Quantity(NamedTuple):
    """How an attribute in SI units is shown."""

    scale: float
    label: str


QUANTITIES: Mapping[str, Quantity] = {
    "accel_mps2": Quantity(1 / STANDARD_GRAVITY_MPS2, "acceleration [g]"),
    "velocity_mps": Quantity(3.6, "velocity [km/h]"),
    "displacement_m": Quantity(MM_PER_M, CRUSH_LABEL),
    "heave_m": Quantity(MM_PER_M, "heave [mm]"),
    "heave_velocity_mps": Quantity(1.0, "heave velocity [m/s]"),
    "pitch_rad": Quantity(180 / math.pi, "pitch, nose down [deg]"),
    "pitch_rate_radps": Quantity(180 / math.pi, "pitch rate [deg/s]"),
}


def quantity(name: str, speed_unit: SpeedUnit = "km/h") -> Quantity:
    """How attribute `name` is shown. ValueError when it is not one that pictures show, or the unit is none."""
    if name not in QUANTITIES:
        raise ValueError(f"quantity = {name!r}: must be one of {', '.join(QUANTITIES)}")
    if speed_unit not in ("km/h", "m/s"):
        raise ValueError(f"speed_unit = {speed_unit!r}: must be 'km/h' or 'm/s'")
    return Quantity(1.0, "velocity [m/s]") if (name, speed_unit) == ("velocity_mps", "m/s") else QUANTITIES[name]


def known(value: float | None) -> float | None:
    """The number, or None when it is unset."""
    return None if value is None or not math.isfinite(value) else float(value)


def vector(values: ArrayLike, name: str) -> Floats:
    """A 1-D array. ValueError with `name` when it is none."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 1:
        raise ValueError(f"{name}: has shape {array.shape}, must be one-dimensional")
    return array


def same_length(**arrays: ArrayLike) -> tuple[Floats, ...]:
    """1-D arrays as long as the first one. ValueError naming the one that is not."""
    vectors = {name: vector(values, name) for name, values in arrays.items()}
    first, reference = next(iter(vectors.items()))
    for name, array in vectors.items():
        if len(array) != len(reference):
            raise ValueError(f"{name}: has {len(array)} values and {first} has {len(reference)}, must be as many")
    return tuple(vectors.values())


def columns(source: object, *names: str, end_time_s: float | None = None) -> tuple[Floats, ...]:
    """Attributes of `source`, as many values of each, up to an end time (the first attribute is time then)."""
    arrays = same_length(**{name: getattr(source, name) for name in names})
    if end_time_s is None:
        return arrays
    count = int(np.searchsorted(arrays[0], end_time_s, side="right"))
    return tuple(array[:count] for array in arrays)


def named(things: OneOrMany[T], name: str) -> list[tuple[str, T]]:
    """Things with the names that the legend shows: their own of a mapping, else `name`, numbered when several."""
    if isinstance(things, Mapping):
        pairs = list(cast("Mapping[str, T]", things).items())
    elif isinstance(things, list | tuple):
        several = cast("list[T]", things)
        pairs = [(f"{name} {i}" if len(several) > 1 else name, thing) for i, thing in enumerate(several, 1)]
    else:
        pairs = [(name, cast(T, things))]
    if not pairs:
        raise ValueError(f"{name}: none given, need at least one")
    return pairs


def option_name(value: Any) -> str:
    """Name of an option's value, an enumerator or a string."""
    return str(getattr(value, "name", value))
