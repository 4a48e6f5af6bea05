"""Arrays in: what NumPy takes for real numbers gives what contiguous float64 gives, bit for bit; the rest is refused.

Arrays out: results own their memory or keep its owner alive, and inputs are never changed.
"""

from __future__ import annotations

import array
import gc
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

import crashsim

Floats: TypeAlias = NDArray[np.float64]

DT_S = 1e-4
FEW = settings(max_examples=15, deadline=None)
HUGE = 2_000_000


def times(count: int) -> Floats:
    return DT_S * np.arange(count)  # type: ignore[return-value]


def pulse_of(accel_mps2: Any) -> Floats:
    pulse = crashsim.make_pulse(times(len(accel_mps2)), accel_mps2, impact_speed_mps=15.0, mass_kg=1200.0)
    return np.concatenate((pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m))


def pulse_at(time_s: Any) -> Floats:
    return np.asarray(crashsim.make_pulse(time_s, np.full(len(time_s), -200.0), impact_speed_mps=15.0).displacement_m)


def curve_of(ordinates: Any) -> Floats:
    curve = crashsim.PiecewiseLinear(np.arange(len(ordinates)), ordinates)
    return np.concatenate((curve.ordinates, curve(np.linspace(0.0, len(ordinates), 7))))


# One array in, one array out, of values of either sign, of values from 0 on, and of times.
OF_VALUES: dict[str, Callable[[Any], Floats]] = {
    "integrate": lambda values: crashsim.integrate(times(len(values)), values),
    "differentiate": lambda values: crashsim.differentiate(times(len(values)), values),
    "cfc_filter": lambda values: crashsim.cfc_filter(values, DT_S, 60),
    "make_pulse": pulse_of,
}
OF_POSITIVE: dict[str, Callable[[Any], Floats]] = {
    "PiecewiseLinear ordinates": curve_of,
    "PiecewiseLinear()": lambda at: crashsim.PiecewiseLinear([0.0, 50.0], [1.0, 2.0])(at),
}
OF_TIMES: dict[str, Callable[[Any], Floats]] = {
    "integrate times": lambda time_s: crashsim.integrate(time_s, np.ones(len(time_s))),
    "differentiate times": lambda time_s: crashsim.differentiate(time_s, np.ones(len(time_s))),
    "make_pulse times": pulse_at,
    "PiecewiseLinear knots": lambda knots: crashsim.PiecewiseLinear(knots, np.ones(len(knots))).knots,
}
FUNCTIONS = {**OF_VALUES, **OF_POSITIVE, **OF_TIMES}


class Exported:
    """Not an array, but can be made one."""

    def __init__(self, values: Floats) -> None:
        self.values = values

    def __len__(self) -> int:
        return len(self.values)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        return np.array(self.values, dtype=dtype)


class Broken:
    """Cannot be made an array."""

    def __len__(self) -> int:
        return 3

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        raise ValueError("cannot be read")


class Subclass(np.ndarray[Any, np.dtype[np.float64]]):
    pass


def every_other(values: Floats) -> Floats:
    wide = np.full(2 * len(values), np.nan)
    wide[::2] = values
    return wide[::2]


def column(values: Floats, order: str) -> Floats:
    table = np.full((len(values), 3), np.nan)
    table[:, 1] = values
    return np.array(table, order=order)[:, 1]  # type: ignore[call-overload, no-any-return]


def read_only(values: Floats) -> Floats:
    copy = values.copy()
    copy.flags.writeable = False
    return copy  # type: ignore[no-any-return]


def unaligned(values: Floats) -> Floats:
    copy = np.zeros(8 * len(values) + 1, dtype=np.uint8)[1:].view(np.float64)
    copy[:] = values
    return copy


LAYOUTS: dict[str, Callable[[Floats], Any]] = {
    "list": lambda values: values.tolist(),
    "tuple": lambda values: tuple(values.tolist()),
    "list of scalars": list,
    "array.array": lambda values: array.array("d", values),
    "memoryview": lambda values: memoryview(values),  # type: ignore[arg-type]
    "__array__": Exported,
    "subclass": lambda values: values.view(Subclass),
    "masked array, nothing masked": np.ma.masked_array,
    "every other": every_other,
    "backwards": lambda values: values[::-1].copy()[::-1],
    "column": lambda values: column(values, "C"),
    "Fortran column": lambda values: column(values, "F"),
    "read-only": read_only,
    "unaligned": unaligned,
    "big endian": lambda values: values.astype(">f8"),
    "little endian": lambda values: values.astype("<f8"),
}
TYPES = ["?", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "g"]


def vectors(low: float) -> st.SearchStrategy[Floats]:
    elements = st.floats(low, 1e3, allow_subnormal=False)
    return hnp.arrays(np.float64, st.integers(12, 60), elements=elements)


def increasing() -> st.SearchStrategy[Floats]:
    steps = hnp.arrays(np.float64, st.integers(12, 60), elements=st.floats(1e-4, 1e-3))
    return steps.map(lambda step: np.concatenate(([0.0], np.cumsum(step))))


def inputs(name: str) -> st.SearchStrategy[Floats]:
    return increasing() if name in OF_TIMES else vectors(0.0 if name in OF_POSITIVE else -1e3)


def bits(values: Any) -> bytes:
    return np.ascontiguousarray(values).tobytes()


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", FUNCTIONS)
@FEW
@given(data=st.data())
def test_layout_does_not_matter_and_inputs_stay(name: str, layout: str, data: st.DataObject) -> None:
    values = data.draw(inputs(name))
    expected, given_before = FUNCTIONS[name](values.copy()), bits(values)
    laid_out = LAYOUTS[layout](values)
    assert bits(FUNCTIONS[name](laid_out)) == bits(expected)
    assert bits(values) == given_before
    assert bits(np.asarray(laid_out, dtype=np.float64)) == given_before


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("name", [*OF_VALUES, *OF_POSITIVE])
@FEW
@given(data=st.data())
def test_numbers_of_any_real_type_are_taken(name: str, dtype: str, data: st.DataObject) -> None:
    kind = np.dtype(dtype).kind
    if kind == "b":
        elements: st.SearchStrategy[Any] = st.booleans()
    elif kind == "f":
        elements = st.integers(0, 100).map(lambda number: number / 8)
    else:
        elements = st.integers(0, 100)
    values = data.draw(hnp.arrays(np.dtype(dtype), st.integers(12, 60), elements=elements))
    before = values.tobytes()
    assert bits(FUNCTIONS[name](values)) == bits(FUNCTIONS[name](values.astype(np.float64)))
    assert values.tobytes() == before


@pytest.mark.parametrize("name", OF_TIMES)
def test_times_may_be_whole_numbers(name: str) -> None:
    for dtype in ("u1", "i4", "i8", "f4"):
        count = np.arange(20, dtype=dtype)
        assert bits(FUNCTIONS[name](count)) == bits(FUNCTIONS[name](count.astype(np.float64)))
    assert bits(FUNCTIONS[name](range(20))) == bits(FUNCTIONS[name](np.arange(20.0)))


GOOD = np.linspace(0.0, 2.0, 21)
REFUSED: dict[str, tuple[Any, type[Exception], str]] = {
    "text": ("0.5", TypeError, "must be an array of real numbers, is <class 'str'>"),
    "bytes": (b"0.5", TypeError, "must be an array of real numbers"),
    "mapping": ({1.0: 2.0}, TypeError, "must be an array of real numbers, is <class 'dict'>"),
    "set": ({1.0, 2.0}, TypeError, "must be an array of real numbers, is <class 'set'>"),
    "iterator": (iter([1.0, 2.0]), TypeError, "must be an array of real numbers, is <class 'list_iterator'>"),
    "objects": (GOOD.astype(object), TypeError, "must be an array of real numbers, its dtype is object"),
    "None inside": ([0.0, None, 1.0], TypeError, "must be an array of real numbers, its dtype is object"),
    "complex": (GOOD.astype(complex), TypeError, "its dtype is complex128"),
    "complex list": ([0.0, 1j], TypeError, "its dtype is complex128"),
    "strings": (np.array(["0", "1"]), TypeError, "its dtype is <U1"),
    "durations": (np.arange(3).astype("m8[s]"), TypeError, "its dtype is timedelta64"),
    "dates": (np.arange(3).astype("M8[s]"), TypeError, "its dtype is datetime64"),
    "records": (np.zeros(3, dtype=[("a", "f8")]), TypeError, "must be an array of real numbers"),
    "whole numbers beyond 64 bits": ([0, 2**70], TypeError, "its dtype is object"),
    "ragged list": ([[0.0], [1.0, 2.0]], ValueError, "must be|inhomogeneous"),
    "masked": (np.ma.masked_greater(GOOD, 1.5), ValueError, "masked"),
    "broken __array__": (Broken(), ValueError, "cannot be read"),
    "table": (np.ones((5, 2)), ValueError, r"must be one-dimensional, its shape is \(5, 2\)"),
    "Fortran table": (np.ones((5, 2), order="F"), ValueError, "must be one-dimensional"),
    "nested list": ([[0.0, 1.0], [2.0, 3.0]], ValueError, "must be one-dimensional"),
    "empty table": (np.ones((0, 2)), ValueError, "must be one-dimensional"),
}


@pytest.mark.parametrize("case", REFUSED)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_is_no_vector_of_real_numbers_is_refused(name: str, case: str) -> None:
    values, error, text = REFUSED[case]
    with pytest.raises(error, match=text):
        call(name, values)


def call(name: str, values: Any) -> Any:
    """A function with values whose length may make no sense."""
    calls: dict[str, Callable[[], Any]] = {
        "integrate": lambda: crashsim.integrate(GOOD, values),
        "differentiate": lambda: crashsim.differentiate(GOOD, values),
        "make_pulse": lambda: crashsim.make_pulse(GOOD, values, impact_speed_mps=15.0),
        "PiecewiseLinear ordinates": lambda: crashsim.PiecewiseLinear(GOOD, values)(0.5),
        "integrate times": lambda: crashsim.integrate(values, GOOD),
        "differentiate times": lambda: crashsim.differentiate(values, GOOD),
        "make_pulse times": lambda: crashsim.make_pulse(values, GOOD, impact_speed_mps=15.0),
        "PiecewiseLinear knots": lambda: crashsim.PiecewiseLinear(values, GOOD)(0.5),
    }
    return calls[name]() if name in calls else FUNCTIONS[name](values)


# Not the call of a curve: it extends to anything, and nothing in gives nothing out.
CHECKED = [name for name in FUNCTIONS if name != "PiecewiseLinear()"]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", CHECKED)
@FEW
@given(data=st.data())
def test_what_is_not_finite_is_refused(name: str, bad: float, data: st.DataObject) -> None:
    values = data.draw(inputs(name))
    values[data.draw(st.integers(0, len(values) - 1))] = bad
    with pytest.raises(ValueError, match=r"finite|must increase|must be 0|must start|pulse starts at"):
        used(name, values)


def used(name: str, values: Any) -> Any:
    """As a curve is checked when it is used."""
    if name == "PiecewiseLinear knots":
        return crashsim.PiecewiseLinear(values, np.ones(len(values)))(0.5)
    return FUNCTIONS[name](values)


@pytest.mark.parametrize("empty", [[], (), np.empty(0), np.empty(0, dtype=np.float32), np.empty(0, dtype=int)])
@pytest.mark.parametrize("name", CHECKED)
def test_nothing_is_refused(name: str, empty: Any) -> None:
    with pytest.raises(ValueError, match=r"samples|knots|times|empty"):
        call(name, empty)


@pytest.mark.parametrize("name", [name for name in CHECKED if name != "cfc_filter"])
@FEW
@given(count=st.integers(1, 60).filter(lambda count: count != len(GOOD)))
def test_lengths_must_be_equal(name: str, count: int) -> None:
    with pytest.raises(ValueError, match="the numbers must be equal"):
        call(name, np.linspace(0.0, 1.0, count))


def test_curve_of_nothing_is_nothing() -> None:
    assert crashsim.PiecewiseLinear([0.0, 1.0], [1.0, 2.0])([]).shape == (0,)


def test_huge_arrays() -> None:
    time_s, ones = times(HUGE), np.ones(HUGE)
    assert crashsim.integrate(time_s, ones)[-1] == pytest.approx(time_s[-1], rel=1e-9)
    assert np.abs(crashsim.cfc_filter(ones, DT_S, 60) - 1.0).max() < 1e-6
    pulse = crashsim.make_pulse(time_s, -ones, impact_speed_mps=15.0)
    assert pulse.time_s.shape == pulse.displacement_m.shape == (HUGE,)
    assert pulse.t_m_s == pytest.approx(15.0)
    curve = crashsim.PiecewiseLinear(np.arange(HUGE), ones)
    assert bits(curve(time_s)) == bits(ones)


def test_results_of_functions_belong_to_the_caller() -> None:
    values = np.linspace(0.0, 1.0, 50)
    for result in (crashsim.integrate(times(50), values), crashsim.cfc_filter(values, DT_S, 60)):
        result[0] = 5.0
        assert result.dtype == np.float64
        assert not np.shares_memory(result, values)


def test_arrays_of_results_are_read_only_and_copy_nothing() -> None:
    pulse = crashsim.make_pulse(times(50), np.full(50, -200.0), impact_speed_mps=15.0)
    assert np.shares_memory(pulse.velocity_mps, pulse.velocity_mps)
    with pytest.raises(ValueError, match="read-only"):
        pulse.velocity_mps[0] = 1.0
    curve = crashsim.PiecewiseLinear([0.0, 1.0], [1.0, 2.0])
    with pytest.raises(ValueError, match="read-only"):
        curve.knots[0] = 1.0


def test_arrays_of_results_outlive_them() -> None:
    pulse = crashsim.make_pulse(times(50_000), np.full(50_000, -2.0), impact_speed_mps=15.0)
    velocity, expected = pulse.velocity_mps, pulse.velocity_mps.copy()
    ordinates = crashsim.CrushModel(1.0, spring=crashsim.PiecewiseLinear([0.0, 1.0], [3.0, 4.0])).spring.ordinates
    del pulse
    gc.collect()
    other = [np.full(50_000, 7.0) for _ in range(20)]
    assert bits(velocity) == bits(expected)
    assert ordinates.tolist() == [3.0, 4.0]
    assert len(other) == 20


def test_results_do_not_follow_their_input() -> None:
    time_s, accel_mps2, knots = times(50), np.full(50, -200.0), np.array([0.0, 0.3])
    pulse = crashsim.make_pulse(time_s, accel_mps2, impact_speed_mps=15.0)
    curve = crashsim.PiecewiseLinear(knots, [1.0, 2.0])
    time_s[:] = accel_mps2[:] = 1e9
    knots[:] = 5.0
    assert pulse.time_s[1] == DT_S
    assert pulse.accel_mps2[0] == -200.0
    assert curve.knots.tolist() == [0.0, 0.3]


@pytest.mark.parametrize("initial", [np.nan, np.inf])
def test_initial_value_of_an_integral_must_be_finite(initial: float) -> None:
    with pytest.raises(ValueError, match="initial"):
        crashsim.integrate(times(50), np.ones(50), initial=initial)


@pytest.mark.parametrize(("last", "count"), [(np.nan, 5), (np.inf, 5), (0.0, 5), (-1.0, 5), (1.0, 0), (1.0, -1)])
def test_uniform_knots_need_a_last_knot_and_a_count(last: float, count: int) -> None:
    with pytest.raises(ValueError, match="last" if count == 5 else "count"):
        crashsim.uniform_knots(last, count)


@pytest.mark.parametrize("at", [None, 1j, "0.5", {}, object()])
def test_curve_is_called_with_real_numbers(at: Any) -> None:
    with pytest.raises(TypeError, match="real number"):
        crashsim.PiecewiseLinear([0.0, 1.0], [1.0, 2.0])(at)


@pytest.mark.parametrize("at", [1, np.float32(1.0), np.int8(1), np.array(1.0), True])
def test_curve_at_one_number_is_a_number(at: Any) -> None:
    assert crashsim.PiecewiseLinear([0.0, 2.0], [1.0, 2.0])(at) == 1.5


@pytest.mark.parametrize("number", [15, np.float32(15), np.int16(15), np.array(15.0), "15 m/s", "54 km/h"])
def test_numbers_of_any_type_are_taken(number: Any) -> None:
    assert crashsim.make_pulse(times(50), np.full(50, -200.0), impact_speed_mps=number).impact_speed_mps == 15.0


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (None, "impact_speed_mps"),
        (np.nan, "impact_speed_mps = nan m/s: must be > 0"),
        (np.inf, "impact_speed_mps"),
        (-1.0, "impact_speed_mps = -1 m/s: must be > 0"),
        (True, "impact_speed_mps: must be a number in m/s or text with a unit, not true or false"),
        ([15.0], "impact_speed_mps: must be a number in m/s or text with a unit, not a list"),
        (1j, "impact_speed_mps"),
        ("fast", "impact_speed_mps"),
        ("15 kg", "impact_speed_mps"),
    ],
)
def test_what_is_no_number_is_refused_by_name(number: Any, text: str) -> None:
    with pytest.raises((ValueError, TypeError), match=text):
        crashsim.make_pulse(times(50), np.full(50, -200.0), impact_speed_mps=number)
