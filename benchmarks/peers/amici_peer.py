"""AMICI: CVODES on generated code; with pyPESTO for multistart identification (Laplace noise: L1).

Usage: amici_peer.py FOLDER [--quick]    compiles the model into FOLDER at first use
"""

import logging
import os
import pathlib
import sys
from collections.abc import Callable
from typing import Any

import harness
import numpy as np
from harness import Array, Crush

ACCELERATION = "-(stiffness * crush + damping * velocity) / mass"
CHANNELS = {"crush": "crush", "velocity": "velocity", "accel": ACCELERATION}
CURVES = {"stiffness": "crush", "damping": "velocity"}  # of what


def curve(name: str, of: str, count: int) -> str:
    """Linear between knots {of}_knot0.. through ordinates {name}_bound times the places {name}0.."""
    pieces = []
    for i in range(count - 1):
        low, high = f"{of}_knot{i}", f"{of}_knot{i + 1}"
        line = f"{name}{i} + ({name}{i + 1} - {name}{i}) * (abs({of}) - {low}) / ({high} - {low})"
        pieces.append(f"{line}, abs({of}) < {high}")
    return f"{name} := {name}_bound * piecewise({', '.join(pieces)}, {name}{count - 1})"


def constants(count: int) -> list[str]:
    knots = [f"{of}_knot{i}" for of in CURVES.values() for i in range(count)]
    return ["mass", "start", *(f"{name}_bound" for name in CURVES), *(f"{name}_size" for name in CHANNELS), *knots]


def places(count: int) -> list[str]:
    return [f"{name}{i}" for name in CURVES for i in range(count)]


def antimony(count: int) -> str:
    """The model in the language Antimony."""
    lines = ["model crush_model()", f"crush' = velocity; velocity' = {ACCELERATION}", "crush = 0; velocity = start"]
    lines += [curve(name, of, count) for name, of in CURVES.items()]
    lines += [f"{name} = {i + 1}" for i, name in enumerate(constants(count))]  # distinct, set before each run
    lines += [f"{name} = 0.5" for name in places(count)]
    return "\n".join([*lines, "end"])


def load_model(folder: pathlib.Path, count: int) -> Any:
    """The model, compiled when it is not there."""
    import amici.sim.sundials
    from amici.importers.antimony import MeasurementChannel, antimony2amici

    name, where = f"crush{count}", folder / "amici"
    if not where.exists():
        channels = [
            MeasurementChannel(f"seen_{channel}", formula=f, noise_distribution="laplace", sigma=f"{channel}_size")
            for channel, f in CHANNELS.items()
        ]
        options = {"fixed_parameters": constants(count), "observation_model": channels}
        antimony2amici(antimony(count), model_name=name, output_dir=where, **options)
    return amici.import_model_module(name, where).get_model()


def set_constants(model: Any, crush: Crush, bounds: Array, sizes: Array) -> None:
    values = {"mass": crush.mass, "start": crush.speed}
    values |= dict(zip([f"{name}_bound" for name in CURVES], bounds))
    values |= dict(zip([f"{name}_size" for name in CHANNELS], sizes))
    # AMICI takes the wrong branch for good when the motion starts on a knot (error 0.09): the last one is moved a bit.
    speeds = crush.damper_knots * np.where(crush.damper_knots < crush.damper_knots[-1], 1.0, 1.0 + 1e-9)
    for of, knots in zip(CURVES.values(), (crush.spring_knots, speeds)):
        values |= {f"{of}_knot{i}": knot for i, knot in enumerate(knots)}
    for name, value in values.items():
        model.set_fixed_parameter_by_id(name, float(value))


def measure_forward(workload: harness.Forward, model: Any, models: int) -> None:
    solver = model.create_solver()
    solver.set_max_steps(100000)

    def simulate(crush: Crush, tolerance: float) -> Array:
        bounds = np.array([crush.spring.max(), crush.damper.max()])
        set_constants(model, crush, bounds, np.ones(3))
        model.set_free_parameters([*(crush.spring / bounds[0]), *(crush.damper / bounds[1])])
        model.set_timepoints(workload.times)
        solver.set_relative_tolerance(tolerance)
        solver.set_absolute_tolerance(tolerance)
        return np.array(model.simulate(solver=solver).y).T

    harness.measure_forward(workload, "AMICI", simulate, models)


def make_objective(fit: harness.Fit, model: Any) -> Any:
    """The Laplace likelihood of places, with its gradient by forward sensitivities."""
    import pypesto
    from amici.sim.sundials import ExpData, SensitivityMethod, SensitivityOrder

    count = len(fit.crush.spring)
    set_constants(model, fit.crush, fit.bounds[[0, -1]], np.abs(fit.target).max(axis=1))
    model.set_timepoints(fit.times)
    solver = model.create_solver()
    solver.set_relative_tolerance(1e-8)
    solver.set_absolute_tolerance(1e-8)
    solver.set_max_steps(100000)
    solver.set_sensitivity_method(SensitivityMethod.forward)
    solver.set_sensitivity_order(SensitivityOrder.first)
    data = ExpData(model)
    data.set_measurements(fit.target.T.flatten())
    return pypesto.AmiciObjective(model, solver, [data], x_ids=places(count))


def make_descend(objective: Any, count: int) -> Callable[[Array], Array]:
    """pyPESTO's L-BFGS-B from one start."""
    import pypesto
    import pypesto.optimize

    problem = pypesto.Problem(objective, lb=np.zeros(count), ub=np.ones(count))

    def descend(start: Array) -> Array:
        problem.set_x_guesses(start[None, :])
        found = pypesto.optimize.minimize(
            problem, pypesto.optimize.ScipyOptimizer("L-BFGS-B"), n_starts=1, progress_bar=False, filename=None
        )
        return np.array(found.optimize_result[0].x)

    return descend


def main() -> None:
    os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"  # AMICI calls swig
    harness.need("amici", "antimony", "pypesto", "scipy")
    folder, quick = harness.arguments()
    logging.disable(logging.ERROR)  # of every simulation that fails on the way
    forward, fit = harness.read_forward(folder), harness.read_fit(folder)
    model = load_model(folder, len(fit.crush.spring))
    measure_forward(forward, model, 5 if quick else 20)
    objective = make_objective(fit, model)
    points = fit.points / fit.bounds
    seconds = harness.median_seconds(lambda: [objective(point, sensi_orders=(0, 1)) for point in points], 3)
    harness.report("gradient", "AMICI forward sensitivities", seconds / len(points))
    harness.measure_fit(fit, "AMICI + pyPESTO", make_descend(objective, len(fit.bounds)), 1 if quick else 4)


if __name__ == "__main__":
    main()
