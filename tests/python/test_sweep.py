"""Sweeps and Monte Carlo from Python: the program's samples, whole or in parts."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

import crashsim
import support

CASE = """\
[impact]
speed = 15
[crush]
model = "{model}"
[simulate]
dt = 0.001
[monte_carlo]
samples = 64
seed = 3
impact.speed = {{normal = [15, 0.3]}}
vehicle.mass = {{uniform = [2500, 2650]}}
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sweep") / "case.toml"
    path.write_text(CASE.format(model=support.DATA / "syn-a/model.json"), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def samples(case: Path) -> crashsim.SampleTable:
    table = crashsim.run_case(case).samples
    assert table is not None
    return table


def test_samples_are_those_of_the_program(case: Path, samples: crashsim.SampleTable, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    subprocess.run([support.program(), "run", case, "-o", tmp_path / "out", "--quiet"], check=True)
    written = pandas.read_csv(tmp_path / "out/samples.csv", comment="#")
    pandas.testing.assert_frame_equal(samples.to_dataframe(), written, check_exact=True, check_dtype=False)


def test_columns_are_views(samples: crashsim.SampleTable) -> None:
    assert len(samples) == samples.planned == 64 and samples.usable and samples.samples[-1] == 63
    speed, crush = samples.column("impact.speed_mps"), samples.column("max_crush_m")
    assert speed.base is samples and not speed.flags.writeable  # type: ignore[comparison-overlap]
    assert speed.mean() == pytest.approx(15.0, abs=0.05) and np.corrcoef(speed, crush)[0, 1] > 0.9
    with pytest.raises(KeyError, match=r"no column .*max_crush.*did you mean .*max_crush_m"):
        samples.column("max_crush")


def test_what_samples_say_together(samples: crashsim.SampleTable) -> None:
    told = samples.statistics()
    (crush,) = [output for output in told.outputs if output.name == "max_crush_m"]
    values = samples.column("max_crush_m")
    assert told.outcomes == (("completed", 64),) and crush.statistics.count == 64
    assert crush.statistics.mean == pytest.approx(values.mean()) and crush.statistics.min_at == values.argmin()
    assert crush.effects[0].pearson == pytest.approx(np.corrcoef(samples.column("impact.speed_mps"), values)[0, 1])
    for value in (samples, told, crush, crush.effects[0], samples.inputs[0], samples.design):
        support.assert_value(value)


def test_parts_make_the_whole(case: Path, samples: crashsim.SampleTable) -> None:
    study = crashsim.read_case(case)
    plan = crashsim.plan_samples(study, crashsim.run_case(study))
    assert len(plan) == 64 and plan.keys == ["impact.speed", "vehicle.mass"] and len(plan.table) == 0
    parts = [crashsim.run_samples(plan, first, 40) for first in (40, 0)]
    assert [len(part) for part in parts] == [24, 40] and not parts[0].usable
    assert crashsim.join_samples(parts) == samples
    with pytest.raises(crashsim.InvalidInput, match="sample 40 follows sample 63"):
        crashsim.join_samples([parts[0], parts[0]])
