"""The package as a whole: documented, typed, with the program's own numbers."""

from __future__ import annotations

import _thread
import ast
import json
import logging
import math
import re
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crashsim
import support
from crashsim import _core

C56 = support.DATA / "fe-car/C56.csv"
REARS = ["LEFT_REAR_VX", "RIGHT_REAR_VX"]
FUNCTIONS = [
    name for name in _core.__all__ if callable(getattr(_core, name)) and not isinstance(getattr(_core, name), type)
]
CLASSES = [name for name in _core.__all__ if isinstance(getattr(_core, name), type)]


@pytest.fixture(scope="module")
def pulse() -> crashsim.Pulse:
    return crashsim.read_pulse(C56, channels=REARS)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_what_it_takes_gives_and_raises(name: str) -> None:
    doc = getattr(crashsim, name).__doc__
    for section in ("Parameters", "Returns", "Raises"):
        assert f"{section}\n{'-' * len(section)}" in doc or (section == "Returns" and ") -> None" in doc), section


@pytest.mark.parametrize("name", CLASSES)
def test_every_class_and_attribute_is_documented(name: str) -> None:
    cls = getattr(crashsim, name)
    assert cls.__doc__
    for member, value in vars(cls).items():
        if isinstance(value, property) and not member.startswith("_"):
            assert value.__doc__, f"{name}.{member}"


def test_the_stub_has_every_public_name_and_attribute() -> None:
    stub = Path(_core.__file__).with_name("_core.pyi")
    if not stub.exists():
        pytest.skip("the stub comes with the installed package")
    tree = ast.parse(stub.read_text(encoding="utf-8"))
    names = {node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    names |= {
        node.target.id for node in tree.body if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    }
    assert set(_core.__all__) <= names
    members = {
        node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        for node in tree.body
        if isinstance(node, ast.ClassDef)
    }
    for name in CLASSES:
        wanted = {item for item in vars(getattr(crashsim, name)) if not item.startswith("_")}
        assert wanted <= members[name] or issubclass(getattr(crashsim, name), BaseException), name


def test_a_case_has_the_programs_files_byte_for_byte(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(support.ROOT)
    program = support.program()
    subprocess.run([program, "run", "data/fe-car/case.toml", "-o", tmp_path / "program", "--quiet"], check=True)
    result = crashsim.run_case("data/fe-car/case.toml", tmp_path / "python")
    files = sorted(path.name for path in (tmp_path / "program").iterdir())
    assert files == sorted(path.name for path in (tmp_path / "python").iterdir())
    for name in files:
        assert (tmp_path / "program" / name).read_bytes() == (tmp_path / "python" / name).read_bytes(), name
    assert result.usable
    summary = json.loads((tmp_path / "program/summary.json").read_text(encoding="utf-8"))
    assert result.summary()["max_crush_m"] == summary["max_crush_m"] == result.response.max_crush_m


def test_step_by_step_gives_the_numbers_of_the_case(pulse: crashsim.Pulse) -> None:
    study = crashsim.read_case(support.DATA / "fe-car/case.toml")
    result = crashsim.run_case(study)
    assert result.pulse is not None and result.identification is not None
    assert result.pulse.accel_mps2.tobytes() == pulse.accel_mps2.tobytes()
    fit = crashsim.identify(pulse, starts=study.options["identify.starts"], seed=study.options["identify.seed"])
    assert fit.model.spring == result.identification.model.spring
    assert fit.error == result.identification.error


def test_the_readmes_example_runs_word_for_word() -> None:
    readme = (support.ROOT / "README.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^```python\n(.*?)^```$", readme, flags=re.MULTILINE | re.DOTALL)
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", example], cwd=support.ROOT, capture_output=True, text=True, check=True
    )
    assert "spring and damper are not separable from one speed" in done.stdout
    assert "crush 0.5478 m at 109.90 ms" in done.stdout and "Rating(overall=0.913" in done.stdout


def test_wrong_words_are_explained(pulse: crashsim.Pulse) -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'strats'; did you mean 'starts'"):
        crashsim.identify(pulse, strats=3)  # type: ignore[call-arg]
    with pytest.raises(crashsim.InvalidInput, match="starts = -1: must be >= 1"):
        crashsim.identify(pulse, starts=-1)
    with pytest.raises(ValueError, match="nofile: no such file"):
        crashsim.read_pulse("nofile")
    with pytest.raises(TypeError, match=r"CrushModel.mass_kg: 'heavy' is of the wrong type"):
        crashsim.CrushModel(mass_kg="heavy")
    with pytest.raises(crashsim.InvalidInput, match=r"make_pulse\.impact_speed_mps"):
        crashsim.make_pulse([0.0, 0.1, 0.2], [0.0, -1.0, 0.0])


def test_results_and_errors_are_values(pulse: crashsim.Pulse) -> None:
    fit = crashsim.identify(pulse, starts=2)
    run = crashsim.simulate(fit.model)
    for value in (pulse, fit, run, fit.model, crashsim.read_traces(C56)):
        support.assert_value(value)
    assert pulse.time_s.base is pulse  # type: ignore[comparison-overlap]
    assert "t_m_s" in pulse._repr_html_() and "<script" not in pulse.replace(channels=("<script>",))._repr_html_()
    assert math.isnan(crashsim.CrushModel().mass_kg)


def test_progress_is_told_and_stops(pulse: crashsim.Pulse) -> None:
    told: list[tuple[int, int]] = []

    def stop(done: int, total: int) -> bool:
        told.append((done, total))
        return False

    fit = crashsim.identify(pulse, starts=5000, progress=stop)
    assert fit.outcome == "interrupted" and told[-1][1] == 5000

    def fail(done: int, total: int) -> None:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        crashsim.identify(pulse, starts=5000, progress=fail)


def test_nothing_is_written_when_a_run_is_broken_off(tmp_path: Path) -> None:
    def press(done: int, total: int) -> None:
        raise KeyboardInterrupt

    case = tmp_path / "case.toml"
    text = (support.DATA / "fe-car/case.toml").read_text(encoding="utf-8").replace('"C56.csv"', f'"{C56}"')
    case.write_text(re.sub(r"starts = \d+", "starts = 50000", text), encoding="utf-8")
    assert "starts = 50000" in case.read_text(encoding="utf-8")
    with pytest.raises(KeyboardInterrupt):
        crashsim.run_case(case, tmp_path / "out", progress=press)
    assert not (tmp_path / "out").exists()


def test_a_bar_is_moved(pulse: crashsim.Pulse) -> None:
    class Bar:
        """The part of tqdm's interface that is used."""

        n = 0
        total = 0

        def update(self, count: int) -> None:
            self.n += count

    bar: Any = Bar()
    crashsim.identify(pulse, starts=400, progress=bar)
    assert bar.total == 400 and 0 < bar.n <= 400


def test_ctrl_c_stops_within_a_second(pulse: crashsim.Pulse) -> None:
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        crashsim.identify(pulse, starts=100_000)


def test_warnings_are_logged(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING, logger="crashsim"):
        pulse = crashsim.read_pulse(C56, channels=REARS)
    assert tuple(record.getMessage() for record in caplog.records) == pulse.warnings


def test_traces_are_a_mapping() -> None:
    traces = crashsim.read_traces(str(C56), channels="*REAR_VX")
    assert "LEFT_REAR_VX" in traces and "nothing" not in traces and len(traces) == len(list(traces))
    trace = traces["LEFT_REAR_VX"]
    assert trace.unit == "m/s" and traces[trace.id] == trace and trace in traces.select("LEFT*VX")
    with pytest.raises(KeyError, match="no channel"):
        traces["nothing"]
    with pytest.raises(IndexError):
        traces[len(traces)]


def test_files_come_back(pulse: crashsim.Pulse, tmp_path: Path) -> None:
    crashsim.write_pulse(pulse, tmp_path / "pulse.csv")
    again = crashsim.read_pulse(tmp_path / "pulse.csv")
    assert np.array_equal(again.accel_mps2, pulse.accel_mps2) and again.t_m_s == pulse.t_m_s
    fit = crashsim.identify(pulse, starts=1)
    crashsim.write_model(fit, tmp_path / "model.json")
    assert crashsim.read_model(tmp_path / "model.json").spring == fit.model.spring
    with pytest.raises(crashsim.InvalidInput, match=r"model\.json"):
        crashsim.write_model(fit.model, tmp_path / "model.json")
    crashsim.write_vehicle(
        crashsim.read_vehicle(support.DATA / "paper/table1.json").replace(mass_kg=2582), tmp_path / "v"
    )
    assert crashsim.read_vehicle(tmp_path / "v").mass_kg == 2582
    run = crashsim.simulate(fit.model)
    crashsim.write_response(run, tmp_path / "response.csv", 1190.02)
    assert np.array_equal(crashsim.read_pulse(tmp_path / "response.csv", cfc=0).accel_mps2, run.accel_mps2)
    crashsim.write_comparison(crashsim.compare(pulse, run), tmp_path / "rating.json")
    assert "channels" in json.loads((tmp_path / "rating.json").read_text(encoding="utf-8"))
    record = crashsim.find_record(tmp_path / "pulse.csv")
    assert record is not None and record["command"] == "python write_pulse"


def test_tables_have_a_column_for_each_curve(pulse: crashsim.Pulse) -> None:
    pytest.importorskip("pandas")
    frame = pulse.to_dataframe()
    assert list(frame) == ["time_s", "accel_mps2", "velocity_mps", "displacement_m"] and len(frame) == len(pulse.time_s)


def test_optional_packages_are_not_imported() -> None:
    check = "import sys, crashsim; print([m for m in ('matplotlib', 'plotly', 'pandas') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
