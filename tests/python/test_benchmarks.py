"""How the benchmarks judge what they measured: benchmarks/ itself is never part of the tests' verdict."""

import importlib
import json
import math
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
PAGE = BENCHMARKS.parent / "docs/benchmarks.md"
ROUNDING = 1e-12  # relative, of logarithms and a few sums


def load(name: str, folder: Path) -> ModuleType:
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(folder))


results = load("results", BENCHMARKS)
targets = load("targets", BENCHMARKS)
report = load("report", BENCHMARKS)
harness = load("harness", BENCHMARKS / "peers")


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
def test_the_exponent_of_a_power_law(power: float) -> None:
    sizes = [10.0, 30.0, 100.0, 1000.0]
    assert results.exponent(sizes, [3.0 * n**power for n in sizes]) == pytest.approx(power, rel=ROUNDING)


def test_exponents_are_those_of_the_larger_sizes() -> None:
    runs = [
        {"workload": "scaling", "engine": "work", "n": n, "seconds": 1.0 if n < 100 else n / 100}
        for n in (1, 10, 100, 1000)
    ]
    ((what, found, power),) = results.fitted_exponents(runs)
    assert what == "work"
    assert [run["n"] for run in found] == [1, 10, 100, 1000]
    assert power == pytest.approx(results.exponent([10, 100, 1000], [1, 1, 10]), rel=ROUNDING)


def test_time_at_an_error_lies_between_two_runs() -> None:
    runs = [{"error": 1e-4, "seconds": 1.0}, {"error": 1e-8, "seconds": 4.0}]
    assert results.seconds_at_error(runs, 1e-6) == pytest.approx(2.0, rel=ROUNDING)
    assert results.seconds_at_error(runs, 1e-8) == 4.0
    assert results.seconds_at_error(runs, 1e-3) == 1.0
    assert results.seconds_at_error(runs, 1e-9) is None


def test_a_better_run_that_is_cheaper_counts() -> None:
    runs = [{"error": 1e-4, "seconds": 3.0}, {"error": 1e-8, "seconds": 2.0}]
    assert results.seconds_at_error(runs, 1e-6) == 2.0


def test_the_ninetieth_percentile_leaves_a_tenth_above() -> None:
    assert harness.ninetieth_percentile([float(i) for i in range(50, 0, -1)]) == 45.0
    assert harness.ninetieth_percentile([3.0]) == 3.0


def test_errors_are_relative_to_each_channel() -> None:
    reference = np.array([[1.0, -2.0], [100.0, 50.0]])
    assert harness.largest_error(reference + np.array([[0.0, 0.2], [1.0, 0.0]]), reference) == pytest.approx(0.1)
    assert math.isnan(harness.largest_error(reference * math.nan, reference))


def test_a_target_is_met_missed_or_not_measured() -> None:
    assert targets.Target(1, "time", 0.9, "<=", 1.0).verdict() == "met"
    assert targets.Target(1, "ratio", 0.9, ">=", 1.0).verdict() == "**missed**"
    assert targets.Target(1, "ratio", None, ">=", 1.0).verdict() == "-"


def test_without_results_nothing_is_judged() -> None:
    found = targets.all_targets([])
    assert {target.point for target in found} == set(range(1, 9))  # growth has only what was measured
    assert {target.verdict() for target in found} == {"-"}


def test_results_are_read_with_their_part(tmp_path: Path) -> None:
    line = {"workload": "W1", "engine": "x", "seconds": 1.0}
    (tmp_path / "engine.jsonl").write_text(json.dumps(line) + "\n")
    assert results.read(tmp_path) == [{**line, "part": "engine"}]


def test_the_page_has_a_place_for_every_table() -> None:
    page = PAGE.read_text()
    for block in report.BLOCKS:
        replaced = report.with_block(page, block.__name__, "new")
        assert f"<!-- begin {block.__name__} -->\n\nnew\n\n<!-- end" in replaced
    with pytest.raises(SystemExit, match="no block '<!-- begin weather -->'"):
        report.with_block(page, "weather", "new")
