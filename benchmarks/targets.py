"""What is asked of crashsim's speed, point by point, beside what was measured."""

import dataclasses
from collections.abc import Iterator, Sequence

from results import Result, fitted_exponents, seconds_at_error, select

FORWARD_ERROR = 1e-6  # at which forward runs are compared


@dataclasses.dataclass(frozen=True)
class Target:
    """`measured` must be `relation` ("<=" or ">=") `bound`. None: not measured."""

    point: int
    what: str
    measured: float | None
    relation: str
    bound: float
    error: float | None = None  # achieved by crashsim there
    digits: int = 3  # worth printing

    def verdict(self) -> str:
        if self.measured is None:
            return "-"
        met = self.measured <= self.bound if self.relation == "<=" else self.measured >= self.bound
        return "met" if met else "**missed**"


def one(results: Sequence[Result], workload: str, engine: str, sundials: str = "") -> Result | None:
    return next(iter(select(results, workload, engine, sundials)), None)


def seconds(result: Result | None) -> float | None:
    return None if result is None else float(result["seconds"])


def quotient(a: float | None, b: float | None) -> float | None:
    return None if a is None or b is None or b == 0.0 else a / b


def scaled(factor: float, a: float | None) -> float | None:
    return None if a is None else factor * a


def integrator_of_record(results: Sequence[Result]) -> Iterator[Target]:
    def at_error(engine: str, sundials: str) -> float | None:
        return seconds_at_error(select(results, "W1", engine, sundials), FORWARD_ERROR)

    ours = at_error("crashsim simulate, cvode", "source")
    for sundials, name, bound in (("system", "packaged", 1 / 4), ("source", "Release", 1 / 1.5)):
        measured = quotient(ours, at_error("CVODE, straightforward", sundials))
        yield Target(1, f"simulate by CVODE / program on {name} CVODE", measured, "<=", bound, FORWARD_ERROR)


def gradients(results: Sequence[Result]) -> Iterator[Target]:
    ours = one(results, "gradient", "crashsim: E and gradient", "source")
    error = None if ours is None else ours.get("error")
    for engine, name in (("crashsim: E alone", "E alone"), ("crashsim: simulate, taylor", "forward run, samples kept")):
        alone = seconds(one(results, "gradient", engine, "source"))
        yield Target(2, f"E and gradient / {name}", quotient(seconds(ours), alone), "<=", 1.2, error)
    for sundials, name, bound in (("system", "packaged", 250), ("source", "Release", 80)):
        peer = seconds(one(results, "gradient", "CVODES sensitivities, without", sundials))
        measured = quotient(peer, seconds(ours))
        yield Target(2, f"{name} CVODES sensitivities / E and gradient", measured, ">=", bound, error)


def hundred_starts(results: Sequence[Result]) -> Iterator[Target]:
    ours = one(results, "W2", "crashsim identify, 100 starts", "source")
    two = one(results, "W2", "crashsim identify, 100 starts, 2 threads", "source")
    yield Target(3, "100 starts, CPU s", seconds(ours), "<=", 0.07)
    peers = (
        ("numba", "numba", "", 60),
        ("SciPy", "best SciPy", "", 250),
        ("CVODES sensitivities", "packaged CVODES + NLopt", "system", 150),
        ("AMICI", "AMICI + pyPESTO", "", 1500),
    )
    for engine, name, sundials, bound in peers:
        runs = select(results, "W2", engine, sundials)
        fastest = min((r["seconds"] for r in runs), default=None)
        yield Target(3, f"{name} / 100 starts", quotient(fastest, seconds(ours)), ">=", bound)
    others = [r["E"] for r in select(results, "W2") if not r["engine"].startswith("crashsim")]
    best = min(others, default=None)
    excess = quotient(ours["E"], best) if ours else None
    yield Target(3, "E / best E of a peer", excess, "<=", 1.0001, digits=6)  # both end within some 1e-5 of a minimum
    yield Target(3, "starts within 0.1 % of the best", ours["at_best"] if ours else None, ">=", 99)
    fewest = min((r["at_best"] for r in select(results, "targets")), default=None)
    yield Target(3, "the same, fewest of ten targets", fewest, ">=", 99)
    efficiency = quotient(ours["wall"], 2 * two["wall"]) if ours and two else None
    yield Target(3, "efficiency on two cores", efficiency, ">=", 0.9)
    scipy = one(results, "process", "import scipy.integrate")
    yield Target(3, "100 starts / import scipy.integrate", quotient(seconds(ours), seconds(scipy)), "<=", 1.0)


def one_start(results: Sequence[Result]) -> Iterator[Target]:
    ours = one(results, "W2", "crashsim equation error + one")
    hundred = one(results, "W2", "crashsim identify, 100 starts")
    yield Target(4, "equation error + one NLopt run, ms", scaled(1e3, seconds(ours)), "<=", 3)
    excess = quotient(ours["E"], hundred["E"]) if ours and hundred else None
    yield Target(4, "its E / E of 100 starts", excess, "<=", 1.001, digits=6)


def heave_and_pitch(results: Sequence[Result]) -> Iterator[Target]:
    peer = next((r for r in select(results, "W3", "CVODE, straightforward", "source") if r["rtol"] == 1e-6), None)
    for engine, name in ((" simulate_pitch, propagator", "simulate_pitch"), (": exact propagator", "propagator alone")):
        ours = one(results, "W3", f"crashsim{engine}", "source")
        error = None if ours is None else ours["error"]
        yield Target(5, f"Release CVODE / {name}", quotient(seconds(peer), seconds(ours)), ">=", 100, error)
        yield Target(5, f"error of {name}", error, "<=", 1e-9, error)


def many_models(results: Sequence[Result]) -> Iterator[Target]:
    taylor = select(results, "many", "crashsim simulate_many, taylor", "source")
    for models, name in ((100, "in the cache"), (1000, "larger than the cache")):
        ours = next((r for r in taylor if r["models"] == models and r.get("rtol") == 1e-8 and "error" in r), None)
        error = None if ours is None else ours["error"]
        yield Target(
            6, f"many models by Taylor, results {name}, us a model", scaled(1e6, seconds(ours)), "<=", 3, error
        )
    batch = seconds_at_error(select(results, "many", "crashsim simulate_many, cvode_batch", "source"), FORWARD_ERROR)
    single = seconds_at_error(select(results, "W1", "CVODE, straightforward", "source"), FORWARD_ERROR)
    measured = quotient(batch, single)
    yield Target(6, "many models by CVODE as one problem / one on Release CVODE", measured, "<=", 1 / 5, FORWARD_ERROR)


def as_a_process(results: Sequence[Result]) -> Iterator[Target]:
    asked = (
        ("crashsim simulate, file to file", 10),
        ("crashsim identify, NHTSA 10146", 300),
        ("crashsim identify, finite-element car", 300),
        ("import crashsim", 100),
    )
    for engine, bound in asked:
        result = one(results, "process", engine)
        yield Target(7, f"{engine}, wall ms", None if result is None else 1e3 * result["wall"], "<=", bound)


def reading(results: Sequence[Result]) -> Iterator[Target]:
    for file, bound in (("v1.EV5", 400), ("nodout", 400), ("binout0000", 1000)):
        row = next((r for r in select(results, "reading", "crashsim") if r["file"] == file), None)
        speed = None if row is None else row["megabytes"] / row["seconds"]
        yield Target(8, f"reading {file}, MB/s", speed, ">=", bound)
        yield Target(8, f"reading {file}, peak memory / arrays kept", row["memory"] if row else None, "<=", 3)


def growth(results: Sequence[Result]) -> Iterator[Target]:
    for what, _, power in fitted_exponents(results):
        if not what.endswith("threads"):
            yield Target(9, f"exponent of {what}", power, "<=", 1.1)


PARTS = (
    integrator_of_record,
    gradients,
    hundred_starts,
    one_start,
    heave_and_pitch,
    many_models,
    as_a_process,
    reading,
    growth,
)


def all_targets(results: Sequence[Result]) -> list[Target]:
    return [target for part in PARTS for target in part(results)]
