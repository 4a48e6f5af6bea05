"""Batches from Python: the program's bytes on every engine, whatever dies meanwhile."""

from __future__ import annotations

import _thread
import json
import logging
import math
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import pytest

import crashsim
import support
from batch_support import ENDLESS, SIMULATED, Killer, children_of, command_of, files_of, write_cases, write_inputs
from crashsim._batch.executors import WorkerProcesses
from crashsim._batch.task import work

COUNT = 16
FAILED = 4  # of them
PATIENCE_S = 20.0


def own_workers() -> list[int]:
    return [pid for pid in children_of(os.getpid()) if b"crashsim._batch" in command_of(pid)]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with cases in in/, and in program/ what the program makes of them."""
    folder = tmp_path_factory.mktemp("batch")
    write_cases(folder / "in", COUNT)
    command = [support.program(), "batch", "in/*.toml", "-o", "program", "--keep-going", "--json", "--quiet"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 3, done.stderr
    (folder / "program.json").write_text(done.stdout, encoding="utf-8")
    return folder


@pytest.fixture(autouse=True)
def there(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(place)


def assert_complete(report: crashsim.BatchReport, out: Path) -> None:
    """A batch of all cases is what the program makes of them."""
    assert (report.done, report.failed, report.exit_code) == (COUNT, FAILED, 3), report
    expected, files = files_of(Path("program")), files_of(out)
    assert sorted(files) == sorted(expected)
    assert [name for name in files if files[name] != expected[name]] == []


def test_own_processes_give_the_programs_bytes_and_report(tmp_path: Path) -> None:
    report = crashsim.run_batch("in/*.toml", tmp_path / "out", jobs=2)
    assert_complete(report, tmp_path / "out")
    told = json.loads(Path("program.json").read_text(encoding="utf-8"))
    for name in ("total", "done", "unchanged", "failed", "retried", "left_over", "interrupted", "exit_code"):
        assert getattr(report, name) == told[name], name
    assert [row.name for row in report.failures] == [row["case"] for row in told["failures"]]
    assert [row.message for row in report.failures] == [row["message"] for row in told["failures"]]
    assert len(report.slowest) == len(told["slowest"]) and report.slowest[0][1] >= report.slowest[-1][1] > 0
    assert report.stages.simulate_s > 0 and own_workers() == []


def test_threads_give_the_same_bytes(tmp_path: Path) -> None:
    with ThreadPoolExecutor(3) as pool:
        assert_complete(crashsim.run_batch("in/*.toml", tmp_path / "out", executor=pool), tmp_path / "out")


def test_a_process_pool_gives_the_same_bytes_also_when_one_is_killed(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        assert_complete(crashsim.run_batch("in/*.toml", tmp_path / "whole", executor=pool), tmp_path / "whole")
        killer = Killer(lambda: list(pool._processes or ()))
        with caplog.at_level(logging.WARNING, logger="crashsim"):
            report = crashsim.run_batch("in/*.toml", tmp_path / "out", executor=pool, progress=killer)
    assert_complete(report, tmp_path / "out")
    assert killer.killed and "a process of the pool died" in caplog.text


def test_a_case_whose_worker_is_killed_is_run_again(tmp_path: Path) -> None:
    killer = Killer(own_workers, times=3)
    report = crashsim.run_batch("in/*.toml", tmp_path / "out", jobs=2, retries=3, progress=killer)
    assert_complete(report, tmp_path / "out")
    assert len(killer.killed) == 3 and 0 < report.retried <= 3


def test_a_case_that_always_loses_its_worker_has_failed(tmp_path: Path) -> None:
    write_inputs(tmp_path)
    (tmp_path / "endless.toml").write_text(ENDLESS, encoding="utf-8")
    (tmp_path / "small.toml").write_text(SIMULATED.format(speed=12), encoding="utf-8")
    killer = Killer(lambda: own_workers()[:1], after=1, times=2)
    report = crashsim.run_batch(
        [tmp_path / "small.toml", tmp_path / "endless.toml"], tmp_path / "out", jobs=1, progress=killer
    )
    (row,) = report.failures
    assert (row.name, row.outcome, row.exit_code, report.retried) == ("endless", "crashed", 4, 1)
    assert "its worker was lost 2 times: WorkerDied: its process was killed by signal 9 (Killed)" in row.message
    assert not (tmp_path / "out/cases/endless").exists() and (tmp_path / "out/cases/small/response.csv").exists()


def test_a_case_that_takes_too_long_has_failed(tmp_path: Path) -> None:
    write_inputs(tmp_path)
    (tmp_path / "endless.toml").write_text(ENDLESS, encoding="utf-8")
    report = crashsim.run_batch(tmp_path / "endless.toml", tmp_path / "out", time_limit_s=0.3)
    (row,) = report.failures
    assert (row.outcome, row.exit_code) == ("time_limit", 3)
    assert row.message == "took longer than the time limit of 0.3 s: give it more, or ask for less"


def test_a_case_that_needs_too_much_memory_has_failed(tmp_path: Path) -> None:
    write_inputs(tmp_path)
    large = SIMULATED.format(speed=12).replace("dt = 0.001", "dt = 0.00001\nend = 90")
    (tmp_path / "large.toml").write_text(large, encoding="utf-8")
    report = crashsim.run_batch(tmp_path / "large.toml", tmp_path / "out", memory_limit_mb=600)
    (row,) = report.failures
    assert (row.outcome, row.exit_code) == ("out_of_memory", 4) and row.message.startswith("out of memory")


def test_stopped_and_resumed_it_ends_with_the_same_bytes(tmp_path: Path) -> None:
    out = tmp_path / "out"
    report = crashsim.run_batch("in/*.toml", out, jobs=1, progress=lambda done, total: done < 5)
    assert report.interrupted and report.exit_code == 130 and 5 <= report.done < COUNT
    with pytest.raises(crashsim.InvalidInput, match="holds a batch already"):
        crashsim.run_batch("in/*.toml", out)
    again = crashsim.run_batch("in/*.toml", out, resume=True)
    assert_complete(again, out)
    assert again.unchanged >= 3  # what failed is run anew


def test_ctrl_c_keeps_what_is_finished(tmp_path: Path) -> None:
    write_inputs(tmp_path)
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(SIMULATED.format(speed=12), encoding="utf-8")
    (tmp_path / "endless.toml").write_text(ENDLESS, encoding="utf-8")
    cases = [tmp_path / f"{name}.toml" for name in ("a", "b", "endless")]
    pressed: list[float] = []

    def press(done: int, total: int) -> None:
        if done == 2 and not pressed:
            pressed.append(time.monotonic())
            threading.Timer(0.2, _thread.interrupt_main).start()

    with pytest.raises(KeyboardInterrupt):
        crashsim.run_batch(cases, tmp_path / "out", jobs=1, progress=press)
    assert time.monotonic() - pressed[0] < 1.2 and own_workers() == []
    (tmp_path / "endless.toml").write_text(SIMULATED.format(speed=13), encoding="utf-8")
    report = crashsim.run_batch(cases, tmp_path / "out", resume=True)
    assert (report.done, report.unchanged, report.failed) == (3, 2, 0)


def test_killed_itself_it_leaves_no_worker_and_goes_on(tmp_path: Path) -> None:
    out = tmp_path / "out"
    script = f"import crashsim; crashsim.run_batch('in/*.toml', {str(out)!r}, jobs=2)"  # no guard of __main__ needed
    process = subprocess.Popen([sys.executable, "-c", script])
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until and len(list(out.glob("cases/*"))) < 3:
        time.sleep(0.01)
    workers = children_of(process.pid)
    process.kill()
    process.wait()
    while time.monotonic() < until and any(Path(f"/proc/{pid}/fd/0").exists() for pid in workers):
        time.sleep(0.01)
    assert workers and not any(Path(f"/proc/{pid}/fd/0").exists() for pid in workers)
    assert_complete(crashsim.run_batch("in/*.toml", out, resume=True), out)


def test_a_failed_case_stops_the_others_when_asked(tmp_path: Path) -> None:
    report = crashsim.run_batch("in/*.toml", tmp_path / "out", jobs=1, keep_going=False)
    assert report.exit_code == 3 and report.failed == 1 and 4 <= report.done < COUNT


def test_shards_are_joined_to_the_same_bytes(tmp_path: Path) -> None:
    shards = [tmp_path / f"shard{i}" for i in (1, 2)]
    for i, shard in enumerate(shards, 1):
        crashsim.run_batch("in/*.toml", shard, shard=f"{i}/2")
    assert_complete(crashsim.merge_batches(shards, tmp_path / "joined").replace(exit_code=3), tmp_path / "joined")


def test_cases_may_be_chosen_from_a_plan(tmp_path: Path) -> None:
    plan = crashsim.plan_batch(["in/c0*.toml"])
    assert len(plan) == 10 and plan[0] == crashsim.BatchCase("c00", "in/c00.toml")
    report = crashsim.run_batch(plan[:3:2], tmp_path / "out", jobs=1)
    assert sorted(path.name for path in (tmp_path / "out/cases").iterdir()) == ["c00", "c02"] and report.exit_code == 0
    for cases, message in (
        ([plan[0], plan[0]], "'c00': is there twice"),
        ([plan[0].replace(name="../c")], r"'../c': is no name for the folder of a case"),
        ([], "no case"),
    ):
        with pytest.raises(crashsim.InvalidInput, match=message):
            crashsim.run_batch(cases, tmp_path / "none")


class Slow(Executor):
    """Runs tasks when it is asked for their results, the last first."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Future[Any], Any]] = []
        self.most = 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.waiting.append((future, lambda: fn(*args, **kwargs)))
        self.most = max(self.most, len(self.waiting))
        return future

    def go_on(self, done: int, total: int) -> None:
        if self.waiting:
            future, task = self.waiting.pop()
            future.set_result(task())


def test_no_more_cases_are_sent_ahead_than_the_window(tmp_path: Path) -> None:
    slow = Slow()
    report = crashsim.run_batch("in/*.toml", tmp_path / "out", executor=slow, window=3, progress=slow.go_on)
    assert_complete(report, tmp_path / "out")
    assert slow.most == 3


class Failing(Executor):
    """Every task ends with the same error."""

    def __init__(self, error: Exception) -> None:
        self._error = error

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(self._error)
        return future


class Broken(Executor):
    """A pool that is not Python's own and takes nothing any more."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        raise BrokenProcessPool("gone")


def test_an_executor_that_cannot_run_cases_says_so(tmp_path: Path) -> None:
    with pytest.raises(crashsim.SystemFailure, match="cannot run cases: ModuleNotFoundError: crashsim; 0 of 16 cases"):
        crashsim.run_batch("in/*.toml", tmp_path / "a", executor=Failing(ModuleNotFoundError("crashsim")))
    report = crashsim.run_batch("in/c00.toml", tmp_path / "b", executor=Failing(ConnectionError("gone")), retries=2)
    assert report.retried == 2
    assert report.failures[0].message == "its worker was lost 3 times: ConnectionError: gone: is there memory enough?"
    with pytest.raises(crashsim.SystemFailure, match="the executor is broken: BrokenProcessPool: gone; 0 of 16 cases"):
        crashsim.run_batch("in/*.toml", tmp_path / "d", executor=Broken())
    with pytest.raises(TypeError, match="executor: must have submit"):
        crashsim.run_batch("in/*.toml", tmp_path / "c", executor="dask")


def test_a_worker_that_does_not_see_the_folder_says_so(tmp_path: Path) -> None:
    answer = work(("c00", "in/c00.toml", str(tmp_path / "elsewhere"), os.getcwd(), ""))
    assert "is not seen by the worker on" in str(answer) and not (tmp_path / "elsewhere").exists()


def test_relative_paths_are_those_of_the_caller(tmp_path: Path) -> None:
    pool = WorkerProcesses(1)
    pool.submit(os.chdir, "/").result(PATIENCE_S)
    try:
        assert_complete(crashsim.run_batch("in/*.toml", tmp_path / "out", executor=pool), tmp_path / "out")
    finally:
        pool.shutdown()


def test_a_full_disk_or_a_folder_in_use_stops_it_with_words(tmp_path: Path) -> None:
    plan = crashsim.plan_batch("in/*.toml")
    with crashsim.BatchFolder(tmp_path / "out", plan) as folder:
        with pytest.raises(crashsim.InvalidInput, match="is in use by process"):
            crashsim.run_batch("in/*.toml", tmp_path / "out", resume=True)
        assert len(folder) == COUNT and folder.case(1).name == "c01" and folder.row_of(0) is None
        with pytest.raises(IndexError, match="case 16 of 16"):
            folder.case(COUNT)
        row = crashsim.run_batch_case(folder.case(0), folder.path)
        folder.record(0, row)
        assert folder.row_of(0) == row and crashsim.is_batch_case_done(folder.case(0), folder.path, row)
        folder.write_tables()
    with pytest.raises(crashsim.InvalidInput, match="BatchFolder: is closed"):
        folder.write_tables()
    assert (tmp_path / "out/results.csv").read_text(encoding="utf-8").splitlines()[1].startswith("c00,completed,")
    (tmp_path / "out/cases").rename(tmp_path / "moved")
    (tmp_path / "out/cases").symlink_to(tmp_path / "moved")
    with pytest.raises(crashsim.SystemFailure):
        crashsim.run_batch("in/*.toml", tmp_path / "out", resume=True)


def test_wrong_words_are_explained(tmp_path: Path) -> None:
    out = tmp_path / "out"
    for options, message in (
        ({"jobs": -1}, "jobs = -1: must be >= 0"),
        ({"retries": -1}, "retries = -1: must be >= 0"),
        ({"window": 0}, "window = 0: must be >= 1"),
        ({"time_limit_s": 0}, "time_limit_s = 0: must be > 0"),
    ):
        with pytest.raises(crashsim.InvalidInput, match=message):
            crashsim.run_batch("in/*.toml", out, **options)  # type: ignore[arg-type]
    with pytest.raises(crashsim.InvalidInput, match="shard '3/2': must be I/N"):
        crashsim.run_batch("in/*.toml", tmp_path / "shard", shard="3/2")
    with ThreadPoolExecutor(1) as pool, pytest.raises(crashsim.InvalidInput, match="for crashsim's own processes"):
        crashsim.run_batch("in/*.toml", out, executor=pool, memory_limit_mb=100)
    with pytest.raises(crashsim.InvalidInput, match=r"no\*\.toml"):
        crashsim.run_batch("in/no*.toml", out)
    assert not out.exists()


def test_rows_and_reports_are_values(tmp_path: Path) -> None:
    report = crashsim.run_batch(["in/c00.toml", "in/c01.toml", "in/c03.toml"], tmp_path / "out", jobs=1)
    with crashsim.BatchFolder(tmp_path / "out", crashsim.plan_batch("in/c01.toml"), resume=True) as folder:
        row = folder.row_of(0)
        assert folder.left_over == 2
    assert row is not None and row.parts["identification"]["starts"] == 20 and not row.failed
    assert row.values["max_crush_m"] > 0 and math.isnan(report.failures[0].values["max_crush_m"])
    for value in (report, row, report.stages, crashsim.BatchCase("a", "b.toml")):
        support.assert_value(value)
    assert crashsim.batch_row_from_json(row.to_json()) == row
    with pytest.raises(crashsim.InvalidInput, match="row of a batch"):
        crashsim.batch_row_from_json("{}")


def test_worker_processes_are_an_executor() -> None:
    pool = WorkerProcesses(2)
    try:
        assert [future.result(PATIENCE_S) for future in [pool.submit(pow, 2, i) for i in range(5)]] == [1, 2, 4, 8, 16]
        with pytest.raises(ZeroDivisionError):
            pool.submit(divmod, 1, 0).result(PATIENCE_S)
        with pytest.raises(Exception, match="its process ended in the middle of it: exit code 7"):
            pool.submit(os._exit, 7).result(PATIENCE_S)
        with pytest.raises(Exception, match="signal 11"):
            pool.submit(signal.raise_signal, signal.SIGSEGV).result(PATIENCE_S)
        assert pool.submit(abs, -1).result(PATIENCE_S) == 1
    finally:
        pool.shutdown()
    assert own_workers() == []


def test_what_is_sent_is_small() -> None:
    task = ("c00", "in/c00.toml", "/somewhere/out", "/somewhere", "")
    assert len(pickle.dumps((work, task))) < 200
