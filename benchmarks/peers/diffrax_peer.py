"""diffrax: Tsit5 under jit; with its gradients and SciPy's SLSQP.

Usage: diffrax_peer.py FOLDER [--quick]
"""

import os
from collections.abc import Callable
from functools import partial
from typing import Any

import harness
import numpy as np
from harness import Array, Crush


def make_run(times: Array) -> Callable[..., Any]:
    import diffrax
    import jax.numpy as jnp

    def acceleration(x: Any, v: Any, curves: Any) -> Any:
        mass, spring_knots, spring, damper_knots, damper = curves
        k, c = jnp.interp(jnp.abs(x), spring_knots, spring), jnp.interp(jnp.abs(v), damper_knots, damper)
        return -(k * x + c * v) / mass

    def rate(t: Any, y: Any, curves: Any) -> Any:
        return jnp.array([y[1], acceleration(y[0], y[1], curves)])

    def run(curves: Any, speed: Any, tolerance: Any) -> Any:
        solution = diffrax.diffeqsolve(
            diffrax.ODETerm(rate), diffrax.Tsit5(), 0.0, times[-1], None, jnp.array([0.0, speed]), curves,
            saveat=diffrax.SaveAt(ts=times), max_steps=16384,
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
        )  # fmt: skip
        x, v = solution.ys.T
        return jnp.array([x, v, acceleration(x, v, curves)])

    return run


def curves_of(model: Crush) -> tuple[Any, ...]:
    return model.mass, model.spring_knots, model.spring, model.damper_knots, model.damper


def make_descend(fit: harness.Fit) -> Callable[[Array], Array]:
    import jax
    import jax.numpy as jnp

    run = make_run(fit.times)
    crush, count = fit.crush, len(fit.crush.spring)
    largest = np.abs(fit.target).max(axis=1)[:, None]

    @jax.jit
    @jax.value_and_grad
    def error(places: Any) -> Any:
        ordinates = places * fit.bounds
        curves = (crush.mass, crush.spring_knots, ordinates[:count], crush.damper_knots, ordinates[count:])
        residuals = jnp.abs(run(curves, crush.speed, 1e-8) - fit.target) / largest
        return residuals.mean(axis=1).sum()

    error(fit.starts[0] / fit.bounds)  # compiled before it is timed

    def value_and_gradient(places: Array) -> tuple[float, Array]:
        value, gradient = error(places)
        return float(value), np.array(gradient)

    return partial(harness.descend_by_slsqp, value_and_gradient, jac=True)


def measure_many(workload: harness.Forward, run: Callable[..., Any], models: int) -> None:
    """All models in one call, vectorised."""
    import jax

    chosen = workload.models[:models]
    curves = tuple(np.stack(values) for values in zip(*(curves_of(model) for model in chosen)))
    speeds = np.array([model.speed for model in chosen])
    together = jax.jit(jax.vmap(run, in_axes=(0, 0, None)))
    for tolerance in (1e-8, 1e-10):
        results = np.array(together(curves, speeds, tolerance))  # compiles
        seconds = harness.median_seconds(lambda t=tolerance: np.array(together(curves, speeds, t)), 3)  # type: ignore[misc]
        errors = [harness.largest_error(r, reference) for r, reference in zip(results, workload.reference)]
        error = harness.ninetieth_percentile(errors)
        harness.report("many", "diffrax Tsit5, vmap", seconds / models, rtol=tolerance, error=error, models=models)


def main() -> None:
    os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")
    harness.need("diffrax", "scipy")
    import jax

    jax.config.update("jax_enable_x64", True)
    folder, quick = harness.arguments()
    forward, fit = harness.read_forward(folder), harness.read_fit(folder)
    run = jax.jit(make_run(forward.times))

    def simulate(model: Crush, tolerance: float) -> Array:
        return np.array(run(curves_of(model), model.speed, tolerance))

    harness.measure_forward(forward, "diffrax Tsit5", simulate, 10 if quick else 50)
    measure_many(forward, make_run(forward.times), 20 if quick else 50)
    harness.measure_fit(fit, "diffrax + SLSQP", make_descend(fit), 1 if quick else 10)


if __name__ == "__main__":
    main()
