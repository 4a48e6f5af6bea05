"""PyCrash's single-degree-of-freedom model. It has no damper: the models of W1 run without theirs, against a barrier
that weighs a million tonnes, and are compared up to maximum crush.

Usage: pycrash_peer.py FOLDER [--quick]
"""

import contextlib
import dataclasses
import io
import statistics
import warnings
from functools import partial

import harness
import numpy as np
from harness import Array, Crush

FOOT, POUND_FORCE, SLUG, MPH = 0.3048, 4.4482216, 14.5939029, 1.46667  # [m], [N], [kg], [ft/s] as PyCrash has it
GRAVITY = 32.2  # [ft/s^2], PyCrash's
BARRIER = 2e12  # [lb]


def simulate(model: Crush) -> tuple[Array, Array]:
    """Times to maximum crush, and x, v, a there."""
    import pandas
    from pycrash.sdof_calcs.sdof_calculations import SingleDOFmodel

    crush = np.linspace(0.0, 2.0, 2001)
    force = np.interp(crush, model.spring_knots, model.spring) * crush
    table = pandas.DataFrame({"disp": crush / FOOT, "force": force / POUND_FORCE})
    weight, speed = model.mass / SLUG * GRAVITY, model.speed / FOOT / MPH
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = SingleDOFmodel(weight, speed, 0, BARRIER, 0.0, 0, table, 0.5, 0.0, "tableK", 0)
    closing = run["v1"].to_numpy(dtype=float) > 0.0
    columns = (run[name].to_numpy(dtype=float)[closing] for name in ("t", "x1", "v1", "a1"))
    times, *motion = columns
    return times, FOOT * np.array(motion)


def reference(model: Crush, times: Array) -> Array:
    from scipy.integrate import solve_ivp

    run = solve_ivp(
        lambda t, y: (y[1], model.acceleration(y[0], y[1])), (0.0, times[-1]), (0.0, model.speed), "DOP853", times,
        rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    return model.channels(*run.y)


def main() -> None:
    harness.need("pycrash", "scipy")
    folder, quick = harness.arguments()
    seconds, errors = [], []
    models = harness.read_forward(folder).models[: 2 if quick else 5]
    for with_damper in models:
        model = dataclasses.replace(with_damper, damper=np.zeros_like(with_damper.damper))
        spent, (times, motion) = harness.timed(partial(simulate, model))
        seconds.append(spent)
        errors.append(harness.largest_error(motion, reference(model, times)))
    error = harness.ninetieth_percentile(errors)
    harness.report("W1", "PyCrash SDOF, without damper", statistics.median(seconds), error=error, models=len(models))


if __name__ == "__main__":
    main()
