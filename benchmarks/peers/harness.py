"""What all Python peers share: the workloads, how time and error are measured, and how results are printed.

A peer is a script `NAME_peer.py FOLDER [--quick]`, FOLDER as `bench_workloads` wrote it. It prints one JSON object a
line, as benchmarks/json_lines.hpp does. Packages that are not installed make it say so and leave.
"""

import argparse
import contextlib
import dataclasses
import importlib
import json
import pathlib
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Outcome = TypeVar("Outcome")
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)


@dataclasses.dataclass(frozen=True)
class Crush:
    """m x'' + c(|v|) v + k(|x|) x = 0, x(0) = 0; curves linear between knots and held beyond the last."""

    mass: float
    speed: float
    spring_knots: Array
    spring: Array
    damper_knots: Array
    damper: Array

    @classmethod
    def from_json(cls, model: dict[str, Any]) -> "Crush":
        curves = (np.array(model[name][part]) for name in ("spring", "damper") for part in ("knots", "ordinates"))
        return cls(model["mass"], model["speed"], *curves)

    def with_ordinates(self, ordinates: Array) -> "Crush":
        count = len(self.spring_knots)
        return dataclasses.replace(self, spring=ordinates[:count], damper=ordinates[count:])

    def acceleration(self, x: Any, v: Any) -> Any:
        k = np.interp(np.abs(x), self.spring_knots, self.spring)
        c = np.interp(np.abs(v), self.damper_knots, self.damper)
        return -(k * x + c * v) / self.mass

    def channels(self, x: Array, v: Array) -> Array:
        return np.array([x, v, self.acceleration(x, v)])


@dataclasses.dataclass(frozen=True)
class Forward:
    """W1."""

    times: Array
    models: list[Crush]
    reference: Array  # model, channel (x, v, a), sample


@dataclasses.dataclass(frozen=True)
class Fit:
    """W2. Parameters are places 0..1 between 0 and the ordinates' bounds."""

    crush: Crush
    times: Array
    target: Array  # channel (x, v, a), sample
    bounds: Array
    starts: Array  # ordinates
    points: Array  # ordinates

    def model(self, places: Array) -> Crush:
        return self.crush.with_ordinates(places * self.bounds)

    def error(self, channels: Array) -> float:
        """E: the channels' mean |residual|, relative to their maxima, added up. Infinite for what is not a motion."""
        if channels.shape != self.target.shape or not np.isfinite(channels).all():
            return float("inf")
        largest = np.abs(self.target).max(axis=1, keepdims=True)
        return float((np.abs(channels - self.target) / largest).mean(axis=1).sum())


@dataclasses.dataclass(frozen=True)
class Pitch:
    """W3: M q'' + C q' + K q = Q, Q linear between samples."""

    times: Array
    mass: Array
    damping: Array
    stiffness: Array
    forces: Array  # sample, (heave, pitch)
    reference: Array  # (z, theta, z', theta'), sample

    def system(self) -> tuple[Array, Array]:
        """A, B of y' = A y + B Q."""
        inverse = np.linalg.inv(self.mass)
        zero, one = np.zeros((2, 2)), np.eye(2)
        a = np.block([[zero, one], [-inverse @ self.stiffness, -inverse @ self.damping]])
        return a, np.vstack([zero, inverse])


def read_json(path: pathlib.Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(path.read_text())
    return content


def read_forward(folder: pathlib.Path) -> Forward:
    w = read_json(folder / "w1.json")
    return Forward(np.array(w["times"]), [Crush.from_json(model) for model in w["models"]], np.array(w["reference"]))


def read_fit(folder: pathlib.Path) -> Fit:
    w = read_json(folder / "w2.json")
    crush = Crush.from_json(w["truth"])
    bounds = np.concatenate(
        [np.full(len(crush.spring), w["spring_upper"]), np.full(len(crush.damper), w["damper_upper"])]
    )
    times, target, starts, points = (np.array(w[name]) for name in ("times", "target", "starts", "points"))
    return Fit(crush, times, target, bounds, starts, points)


def read_pitch(folder: pathlib.Path) -> Pitch:
    w = read_json(folder / "w3.json")
    forces = np.array([w["heave_force"], w["pitch_moment"]]).T
    times, mass, damping, stiffness = (np.array(w[name]) for name in ("times", "mass", "damping", "stiffness"))
    return Pitch(times, mass, damping, stiffness, forces, np.array(w["reference"]))


def largest_error(result: Array, reference: Array) -> float:
    """Largest error of each channel relative to its largest value; the worst of them."""
    return float((np.abs(result - reference).max(axis=1) / np.abs(reference).max(axis=1)).max())


def ninetieth_percentile(errors: Sequence[float]) -> float:
    """Value that 90 % of the errors do not exceed."""
    return sorted(errors)[(len(errors) * 9 + 9) // 10 - 1]


def timed(work: Callable[[], Outcome]) -> tuple[float, Outcome]:
    """CPU time of the process (CLOCK_PROCESS_CPUTIME_ID) for one call, and what it gave."""
    start = time.process_time()
    outcome = work()
    return time.process_time() - start, outcome


def median_seconds(work: Callable[[], object], repetitions: int) -> float:
    return statistics.median(timed(work)[0] for _ in range(repetitions))


def report(workload: str, engine: str, seconds: float, **more: object) -> None:
    print(json.dumps({"workload": workload, "engine": engine, "seconds": seconds, **more}), flush=True)


def measure_forward(
    workload: Forward, engine: str, simulate: Callable[[Crush, float], Array], models: int = 50
) -> None:
    """Times `simulate(model, tolerance)`, which returns channels, over the first models, at several tolerances."""
    for tolerance in TOLERANCES:
        chosen = workload.models[:models]
        simulate(chosen[0], tolerance)  # compiles what is compiled on first use
        runs = [timed(partial(simulate, model, tolerance)) for model in chosen]
        errors = [largest_error(result, reference) for (_, result), reference in zip(runs, workload.reference)]
        seconds = statistics.median(seconds for seconds, _ in runs)
        report("W1", engine, seconds, rtol=tolerance, error=ninetieth_percentile(errors), models=models)


def measure_fit(workload: Fit, engine: str, descend: Callable[[Array], Array], starts: int) -> None:
    """Times `descend(places)`, which returns better places, from the first starts; extrapolates to all 100."""
    runs = [timed(partial(descend, start / workload.bounds)) for start in workload.starts[:starts]]
    errors = [accurate_error(workload, np.clip(places, 0.0, 1.0)) for _, places in runs]
    seconds = sum(seconds for seconds, _ in runs) * 100 / starts
    report("W2", engine, seconds, starts=starts, E=min(errors), ends=errors)


def descend_by_slsqp(function: Callable[[Array], Any], places: Array, jac: bool = False) -> Array:
    """SciPy's SLSQP as one would set it up with care: differences well above the noise of the simulation."""
    from scipy.optimize import minimize

    options = {"ftol": 1e-9, "maxiter": 1000} | ({} if jac else {"eps": 1e-5})
    bounds = [(0.0, 1.0)] * len(places)
    return np.array(minimize(function, places, jac=jac, method="SLSQP", bounds=bounds, options=options).x)


def accurate_error(workload: Fit, places: Array) -> float:
    """E of places by a tight independent simulation, whatever engine found them."""
    from scipy.integrate import solve_ivp

    model = workload.model(places)
    run = solve_ivp(
        lambda t, y: (y[1], model.acceleration(y[0], y[1])),
        (0.0, workload.times[-1]), (0.0, model.speed), "DOP853", workload.times, rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    return workload.error(model.channels(*run.y))


def need(*packages: str) -> None:
    """Leaves with a message when a package is not installed."""
    for package in packages:
        try:
            with contextlib.redirect_stdout(sys.stderr):  # results only
                importlib.import_module(package)
        except Exception as problem:  # whatever a foreign package does when it is loaded
            print(f"{pathlib.Path(sys.argv[0]).stem}: skipped: {package}: {problem}", file=sys.stderr)
            raise SystemExit(0) from None


def arguments() -> tuple[pathlib.Path, bool]:
    """Folder of the workloads, and whether to be quick."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="fewer models, starts and repetitions")
    given = parser.parse_args()
    return given.folder, given.quick
