"""LSODA compiled by numba (numbalsoda), alone and with SciPy's SLSQP.

Usage: numba_peer.py FOLDER [--quick]
"""

from collections.abc import Callable
from functools import partial

import harness
import numpy as np
from harness import Array, Crush


def make_simulate(times: Array) -> Callable[[Crush, float], Array]:
    """Channels of a model; the right-hand side gets mass, number of knots and both curves in one array."""
    import numba
    from numbalsoda import lsoda, lsoda_sig

    @numba.njit(inline="always")
    def curve(data: Array, offset: int, count: int, s: float) -> float:
        for i in range(count - 1):
            low, high = data[offset + i], data[offset + i + 1]
            if s < high:
                weight = (s - low) / (high - low)
                return (1.0 - weight) * data[offset + count + i] + weight * data[offset + count + i + 1]
        return data[offset + 2 * count - 1]

    @numba.njit(inline="always")
    def acceleration(data: Array, x: float, v: float) -> float:
        count = int(data[1])
        k, c = curve(data, 2, count, abs(x)), curve(data, 2 + 2 * count, count, abs(v))
        return -(k * x + c * v) / data[0]

    @numba.cfunc(lsoda_sig)
    def rate(t, u, du, p):  # type: ignore[no-untyped-def]
        data = numba.carray(p, (40,))
        du[0] = u[1]
        du[1] = acceleration(data, u[0], u[1])

    @numba.njit
    def run(address: int, data: Array, speed: float, times: Array, tolerance: float) -> Array:
        y, _ = lsoda(address, np.array([0.0, speed]), times, data, rtol=tolerance, atol=tolerance)
        out = np.empty((3, len(times)))
        for i in range(len(times)):
            out[0, i], out[1, i] = y[i, 0], y[i, 1]
            out[2, i] = acceleration(data, y[i, 0], y[i, 1])
        return out

    def simulate(model: Crush, tolerance: float) -> Array:
        data = np.zeros(40)
        head = [model.mass, len(model.spring_knots)]
        parts = np.concatenate([head, model.spring_knots, model.spring, model.damper_knots, model.damper])
        data[: len(parts)] = parts
        return np.array(run(rate.address, data, model.speed, times, tolerance))

    return simulate


def main() -> None:
    harness.need("numba", "numbalsoda", "scipy")
    folder, quick = harness.arguments()
    forward, fit = harness.read_forward(folder), harness.read_fit(folder)
    simulate = make_simulate(forward.times)
    harness.measure_forward(forward, "numba, numbalsoda", simulate)
    simulate = make_simulate(fit.times)
    simulate(fit.crush, 1e-8)  # compiled before it is timed
    error = lambda places: fit.error(simulate(fit.model(places), 1e-8))  # noqa: E731
    harness.measure_fit(fit, "numba + SLSQP", partial(harness.descend_by_slsqp, error), 2 if quick else 50)


if __name__ == "__main__":
    main()
