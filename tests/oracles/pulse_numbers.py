"""Pulse metrics by NumPy and SciPy, from their definitions alone: no code of crashsim, other methods throughout.

Usage: pulse_numbers.py < motions.json, a list of {"time_s", "accel_mps2", "velocity_mps", "displacement_m", "mass_kg"},
uniform in time. Prints a list of {"olc_g", "t1_s", "t2_s", "vpi_g", "sm10_g", .., "asi_1998", "asi_2010",
"kw400_n_per_m"}.
"""

import json
import sys
from collections.abc import Callable

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq
from scipy.signal import lfilter

G = 9.80665
Array = np.ndarray


def path_of(m: dict[str, Array]) -> tuple[Callable[[float], float], Callable[[float], float]]:
    """Displacement and velocity at any time from 0 on; after the record the vehicle keeps its velocity."""
    t, v, x = m["time_s"], m["velocity_mps"], m["displacement_m"]
    spline = CubicHermiteSpline(t, x, v)
    slope = spline.derivative()
    last = t[-1]
    return (
        lambda s: float(spline(s)) if s <= last else float(x[-1] + v[-1] * (s - last)),
        lambda s: float(slope(s)) if s <= last else float(v[-1]),
    )


def olc(m: dict[str, Array]) -> dict[str, float]:
    x, v = path_of(m)
    v0 = m["velocity_mps"][0]
    longest = m["time_s"][-1] + 1.0
    t1 = brentq(lambda t: v0 * t - x(t) - 0.065, 0.0, longest, xtol=1e-15, rtol=1e-14)
    t2 = brentq(lambda t: 0.5 * (v0 + v(t)) * (t - t1) - (x(t) - x(t1)) - 0.235, t1, longest, xtol=1e-15, rtol=1e-14)
    return {"olc_g": (v0 - v(t2)) / (t2 - t1) / 9.81, "t1_s": t1, "t2_s": t2}


def vpi_g(m: dict[str, Array]) -> float:
    """A unit mass on a belt of 2500 N/m with 30 mm slack, in a vehicle that accelerates linearly between samples."""
    t, a = m["time_s"], m["accel_mps2"]

    def rate(s: float, y: Array) -> Array:
        vehicle = np.interp(s, t, a) if s <= t[-1] else 0.0
        return np.array([y[1], -2500.0 * max(y[0] - 0.03, 0.0) - vehicle])

    largest, start, state = 0.0, 0.0, np.zeros(2)
    for end in (t[-1], t[-1] + 0.2):
        found = solve_ivp(rate, (start, end), state, rtol=1e-11, atol=1e-13, max_step=5e-5)
        largest = max(largest, float(np.max(found.y[0])))
        start, state = end, found.y[:, -1]
    return 2500.0 * max(largest - 0.03, 0.0) / G


def sliding_mean_g(m: dict[str, Array], window_s: float) -> float:
    """Largest mean deceleration of any window that starts or ends at a sample, velocity linear between samples."""
    t, v = m["time_s"], m["velocity_mps"]
    starts = np.concatenate([t, t - window_s])
    slack = 1e-9 * window_s
    starts = starts[(starts >= t[0] - slack) & (starts + window_s <= t[-1] + slack)]
    return float(np.max(np.interp(starts, t, v) - np.interp(starts + window_s, t, v)) / window_s / G)


def asi_1998(m: dict[str, Array]) -> float:
    """Moving mean over 50 ms as a convolution, trapezoids at its ends."""
    dt = m["time_s"][1] - m["time_s"][0]
    n = round(0.05 / dt)
    weights = np.full(n + 1, dt)
    weights[[0, -1]] /= 2
    return float(np.max(np.abs(np.convolve(m["accel_mps2"], weights, "valid"))) / 0.05 / (12 * G))


def twice_filtered(x: Array, b: Array, a: Array) -> Array:
    return lfilter(b, a, lfilter(b, a, x)[::-1])[::-1]


def butterworth(cutoff: float, dt: float) -> tuple[Array, Array]:
    """Second order, by the bilinear transform with the frequency warped."""
    w = np.tan(np.pi * cutoff * dt)
    d = 1 + np.sqrt(2) * w + w * w
    return np.array([1.0, 2.0, 1.0]) * w * w / d, np.array([1.0, 2 * (w * w - 1) / d, (1 - np.sqrt(2) * w + w * w) / d])


def asi_2010(m: dict[str, Array]) -> float:
    """CFC180 of SAE J211 with ends mirrored oddly over 10 ms, then 13 Hz with ends held for half a second."""
    dt, x = m["time_s"][1] - m["time_s"][0], m["accel_mps2"]
    n = round(0.01 / dt)
    mirrored = np.concatenate([2 * x[0] - x[n:0:-1], x, 2 * x[-1] - x[-2 : -n - 2 : -1]])
    clean = twice_filtered(mirrored, *butterworth(180 * 2.0775, dt))[n:-n]
    rest = round(0.5 / dt)
    padded = np.concatenate([np.full(rest, clean[0]), clean, np.full(rest, clean[-1])])
    smooth = twice_filtered(padded, *butterworth(13 * 1.25, dt))[rest:-rest]
    return float(np.max(np.abs(smooth)) / (12 * G))


def kw400(m: dict[str, Array]) -> float:
    """Work of -m a over 25..400 mm by adaptive quadrature of the force over crush as a polyline."""
    x, force = m["displacement_m"], -m["mass_kg"] * m["accel_mps2"]
    rising = int(np.argmax(x)) + 1
    knots = x[:rising][(x[:rising] > 0.025) & (x[:rising] < 0.4)]
    edges = np.concatenate([[0.025], knots, [0.4]])
    pieces = [quad(lambda s: np.interp(s, x[:rising], force[:rising]), a, b)[0] for a, b in zip(edges, edges[1:])]
    return 2 * sum(pieces) / (0.4**2 - 0.025**2)


def numbers_of(motion: dict[str, list[float] | float]) -> dict[str, float]:
    m = {name: np.array(values) for name, values in motion.items()}
    found = {**olc(m), "vpi_g": vpi_g(m), "asi_1998": asi_1998(m), "asi_2010": asi_2010(m), "kw400_n_per_m": kw400(m)}
    for window in (10, 25, 38, 50):
        found[f"sm{window}_g"] = sliding_mean_g(m, window / 1000)
    return found


def main() -> None:
    json.dump([numbers_of(motion) for motion in json.load(sys.stdin)], sys.stdout)


if __name__ == "__main__":
    main()
