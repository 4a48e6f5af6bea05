"""SciPy: odeint and solve_ivp; with SLSQP, and with L-BFGS-B as it comes; lsim.

Usage: scipy_peer.py FOLDER [--quick]
"""

from functools import partial

import harness
import numpy as np
from harness import Array, Crush


def with_odeint(times: Array, model: Crush, tolerance: float) -> Array:
    from scipy.integrate import odeint

    def rate(y: Array, t: float) -> tuple[float, float]:
        return y[1], model.acceleration(y[0], y[1])

    y = odeint(rate, (0.0, model.speed), times, rtol=tolerance, atol=tolerance)
    return model.channels(*y.T)


def with_solve_ivp(times: Array, method: str, model: Crush, tolerance: float) -> Array:
    from scipy.integrate import solve_ivp

    run = solve_ivp(
        lambda t, y: (y[1], model.acceleration(y[0], y[1])), (0.0, times[-1]), (0.0, model.speed), method, times,
        rtol=tolerance, atol=tolerance,
    )  # fmt: skip
    return model.channels(*run.y)


def descend_as_it_comes(fit: harness.Fit, places: Array) -> Array:
    """L-BFGS-B on solve_ivp, with default differences."""
    from scipy.optimize import minimize

    simulate = partial(with_solve_ivp, fit.times, "RK45")
    bounds = [(0.0, 1.0)] * len(places)
    found = minimize(lambda p: fit.error(simulate(fit.model(p), 1e-8)), places, method="L-BFGS-B", bounds=bounds)
    return np.array(found.x)


def measure_pitch(workload: harness.Pitch, quick: bool) -> None:
    from scipy.integrate import odeint
    from scipy.signal import StateSpace, lsim

    a, b = workload.system()
    system = StateSpace(a, b, np.eye(4), np.zeros((4, 2)))
    repetitions = 5 if quick else 21

    def by_lsim() -> Array:
        return np.array(lsim(system, workload.forces, workload.times)[1]).T

    def by_odeint(tolerance: float) -> Array:
        def rate(y: Array, t: float) -> Array:
            force = [np.interp(t, workload.times, column) for column in workload.forces.T]
            return a @ y + b @ force

        return np.array(odeint(rate, np.zeros(4), workload.times, rtol=tolerance, atol=tolerance)).T

    seconds = harness.median_seconds(by_lsim, repetitions)
    harness.report("W3", "SciPy lsim", seconds, error=harness.largest_error(by_lsim(), workload.reference))
    seconds = harness.median_seconds(partial(by_odeint, 1e-6), 3)
    error = harness.largest_error(by_odeint(1e-6), workload.reference)
    harness.report("W3", "SciPy odeint", seconds, rtol=1e-6, error=error)


def main() -> None:
    harness.need("scipy")
    folder, quick = harness.arguments()
    forward, fit = harness.read_forward(folder), harness.read_fit(folder)
    models = 10 if quick else 50
    harness.measure_forward(forward, "SciPy odeint", partial(with_odeint, forward.times), models)
    for method in ("RK45", "DOP853"):
        simulate = partial(with_solve_ivp, forward.times, method)
        harness.measure_forward(forward, f"SciPy solve_ivp {method}", simulate, models)
    measure_pitch(harness.read_pitch(folder), quick)
    error = lambda places: fit.error(with_odeint(fit.times, fit.model(places), 1e-8))  # noqa: E731
    harness.measure_fit(fit, "SciPy odeint + SLSQP", partial(harness.descend_by_slsqp, error), 1 if quick else 10)
    if not quick:  # half a minute a start
        harness.measure_fit(fit, "SciPy solve_ivp + L-BFGS-B, as it comes", partial(descend_as_it_comes, fit), 3)


if __name__ == "__main__":
    main()
