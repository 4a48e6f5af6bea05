"""run_batch(): from cases and an executor to the folder of a batch."""

from __future__ import annotations

import contextlib
import logging
import os
import pickle
import queue
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from .. import _core
from .executors import WorkerDied, WorkerProcesses
from .tally import Tally
from .task import MACHINE_FAILED, NUMBERS_FAILED, Answer, Task, failed_row, work

Path = str | os.PathLike[str]
Progress = Callable[[int, int], bool | None]

NOT_RUNNABLE = (ImportError, AttributeError, NameError, SyntaxError, TypeError, pickle.PickleError)
LOOK_AROUND_S = 0.1
LONGEST_MESSAGE = 1000
LOGGER = logging.getLogger("crashsim")


def run_batch(
    cases: Path | Sequence[Path] | Sequence[_core.BatchCase],
    out_dir: Path,
    *,
    executor: Any = None,
    jobs: int = 0,
    shard: str = "1/1",
    resume: bool = False,
    keep_going: bool = True,
    time_limit_s: float | None = None,
    memory_limit_mb: float | None = None,
    retries: int = 1,
    window: int = 1000,
    progress: Progress | Any = None,
) -> _core.BatchReport:
    """Runs many cases on an executor: the files of ``crashsim batch``, byte for byte.

    The folder gets ``cases/NAME`` each, ``results.csv`` and ``results.jsonl`` with a row each in the order of the
    cases, ``timings.csv`` and ``batch.json``. What is finished is kept whatever happens: `resume` goes on to the same
    bytes. Only names go to workers and only rows come back, so that all must see the same file system.

    Parameters
    ----------
    cases : str, os.PathLike, sequence of them, or of BatchCase
        Case files, records, globs or manifests, as plan_batch() takes them; or what it gave.
    out_dir : str or os.PathLike
        Folder of the batch.
    executor : concurrent.futures.Executor, distributed.Client or None
        What runs the cases; None: processes of crashsim's own. A process pool of Python breaks when one of its
        processes dies: the batch then goes on with as many processes of its own.
    jobs : int
        Number of own processes; 0: all cores.
    shard : str
        ``'I/N'``: of every N cases the I-th; merge_batches() joins the folders.
    resume : bool
        Go on in a folder with results: do what is not done, or has changed.
    keep_going : bool
        Finish the others when a case fails.
    time_limit_s, memory_limit_mb : float, optional
        Of one case in an own process: time, and the address space of the process [MB]. A case that needs more has
        failed.
    retries : int
        How often a case is run again whose worker was killed or lost.
    window : int
        Most cases that the executor is given ahead.
    progress : callable or tqdm bar, optional
        ``progress(done, total)`` is called at least ten times a second; return False to stop. A tqdm bar is moved.

    Returns
    -------
    BatchReport
        Look at ``exit_code`` and ``failures``: a case that fails is told there, and by its row.

    Raises
    ------
    InvalidInput
        On cases that are none; when the folder holds results already (without `resume`), other things, or another
        shard, or is in use.
    SystemFailure
        When files cannot be written, or the executor cannot run anything.
    KeyboardInterrupt
        On Ctrl-C, within a second; what is finished is kept. An executor of yours may still be writing the cases
        that were running: shut it down before you go on with ``resume=True``.

    Examples
    --------
    >>> report = crashsim.run_batch("data/paper/*.toml", "study")  # doctest: +SKIP
    >>> report.done, report.failed  # doctest: +SKIP
    (2, 0)
    """
    for name, value, least in (("jobs", jobs, 0), ("retries", retries, 0), ("window", window, 1)):
        if value < least:
            raise _core.InvalidInput(f"{name} = {value}: must be >= {least}")
    _check_limit("time_limit_s", time_limit_s, executor)
    _check_limit("memory_limit_mb", memory_limit_mb, executor)
    own = WorkerProcesses(jobs, time_limit_s, memory_limit_mb) if executor is None else None
    engine = own or _executor_of(executor)
    with _core.BatchFolder(os.path.abspath(out_dir), _plan(cases), shard=shard, resume=resume) as folder:
        return _Batch(folder, engine, keep_going, retries, window, progress).run()


def _check_limit(name: str, limit: float | None, executor: Any) -> None:
    if limit is not None and not limit > 0:
        raise _core.InvalidInput(f"{name} = {limit}: must be > 0")
    if limit is not None and executor is not None:
        raise _core.InvalidInput(f"{name}: is for crashsim's own processes: leave out executor, or limit its workers")


def _plan(cases: Any) -> tuple[_core.BatchCase, ...]:
    if isinstance(cases, (str, os.PathLike)):
        return _core.plan_batch(cases)
    given = tuple(cases)
    if not all(isinstance(case, _core.BatchCase) for case in given):
        return _core.plan_batch(given)
    if not given:
        raise _core.InvalidInput("no case: name case files, globs or manifests")
    names = set()
    for case in given:
        if not case.name or case.name.startswith(".") or "/" in case.name or not case.name.isprintable():
            raise _core.InvalidInput(f"BatchCase.name = {case.name!r}: is no name for the folder of a case")
        if case.name in names:
            raise _core.InvalidInput(f"BatchCase.name = {case.name!r}: is there twice")
        names.add(case.name)
    return given


def _executor_of(given: Any) -> Any:
    """Dask's client has one that does not take two calls with the same arguments for the same."""
    if hasattr(given, "get_executor"):
        return given.get_executor(pure=False)
    if not callable(getattr(given, "submit", None)):
        raise TypeError(f"executor: must have submit() as concurrent.futures.Executor has, is {type(given).__name__}")
    return given


class _Batch:
    """One run: cases go out, rows come in."""

    def __init__(
        self, folder: _core.BatchFolder, engine: Any, keep_going: bool, retries: int, window: int, progress: Any
    ) -> None:
        self._folder = folder
        self._engine = engine
        self._keep_going = keep_going
        self._retries = retries
        self._window = window
        self._progress = progress
        self._start = os.getcwd()
        self._next = 0
        self._again: deque[int] = deque()
        self._deaths: dict[int, int] = {}
        self._running: dict[Future[Any], int] = {}
        self._finished: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._stops = False
        self._tally = Tally(len(folder), folder.left_over)

    def run(self) -> _core.BatchReport:
        try:
            while self._tell() and self._has_work():
                self._send_ahead()
                self._look_around()
        except BaseException:
            self._leave(at_once=True)
            raise
        self._leave(at_once=self._tally.interrupted)
        if not self._tally.interrupted:
            self._folder.write_tables()
        return self._tally.report()

    def _tell(self) -> bool:
        """False: stop. A bar such as tqdm's is brought to where the work is, a function is called."""
        done, total = self._tally.done, self._tally.total
        if hasattr(self._progress, "update"):
            self._progress.total = total
            self._tally.interrupted = self._progress.update(done - self._progress.n) is False
        elif self._progress is not None:
            self._tally.interrupted = self._progress(done, total) is False
        return not self._tally.interrupted

    def _has_work(self) -> bool:
        return bool(self._running) or (not self._stops and (bool(self._again) or self._next < self._tally.total))

    def _send_ahead(self) -> None:
        while not self._stops and len(self._running) < self._window:
            if self._again:
                index = self._again.popleft()
            elif self._next < self._tally.total:
                index = self._next
                self._next += 1
            else:
                return
            self._send(index)

    def _send(self, index: int) -> None:
        case, before = self._folder.case(index), self._folder.row_of(index)
        task = Task(case.name, case.path, self._folder.path, self._start, before.to_json() if before else "")
        try:
            future = self._engine.submit(work, tuple(task))
        except BrokenProcessPool as error:
            self._go_on_without_the_pool()
            if not self._has_own_way():
                raise _core.SystemFailure(f"the executor is broken: {_text_of(error)}{self._how_to_go_on()}") from error
            future = self._engine.submit(work, tuple(task))
        self._running[future] = index
        future.add_done_callback(self._finished.put)

    def _look_around(self) -> None:
        """Takes what is finished; waits for it a little when nothing is."""
        with contextlib.suppress(queue.Empty):
            self._take(self._finished.get(timeout=LOOK_AROUND_S))

    def _take(self, future: Future[Any]) -> None:
        index = self._running.pop(future, None)
        if index is None:  # called off
            return
        error = CancelledError("its task was dropped") if future.cancelled() else future.exception()
        if error is None:
            self._read(index, Answer(*future.result()))
        elif isinstance(error, BrokenProcessPool) and self._has_own_way():
            self._again.append(index)  # which case did it, nobody knows: none is blamed
            self._go_on_without_the_pool()
        elif isinstance(error, NOT_RUNNABLE) or type(error) is RuntimeError:
            raise _core.SystemFailure(
                f"the executor cannot run cases: {_text_of(error)}{self._how_to_go_on()}"
            ) from error
        else:
            self._mourn(index, error)

    def _read(self, index: int, answer: Answer) -> None:
        if answer.invalid_input:
            raise _core.InvalidInput(answer.invalid_input)
        if answer.system_failure:
            raise _core.SystemFailure(answer.system_failure + self._how_to_go_on())
        if answer.unchanged:
            row = self._folder.row_of(index)
            assert row is not None
            self._tally.unchanged += 1
            self._tally.count(index, row)
        else:
            self._keep(index, _core.batch_row_from_json(answer.row))

    def _mourn(self, index: int, error: BaseException) -> None:
        """A worker ended with a case in its hands."""
        name = self._folder.case(index).name
        if isinstance(error, WorkerDied) and error.is_late:
            return self._keep(index, failed_row(name, "time_limit", NUMBERS_FAILED, str(error)))
        if isinstance(error, WorkerDied) and error.is_own_fault:
            return self._keep(index, failed_row(name, "crashed", MACHINE_FAILED, str(error)))
        deaths = self._deaths[index] = self._deaths.get(index, 0) + 1
        if deaths <= self._retries:
            self._tally.retried += 1
            self._again.append(index)
            return None
        message = f"its worker was lost {deaths} times: {_text_of(error)}: is there memory enough?"
        return self._keep(index, failed_row(name, "crashed", MACHINE_FAILED, message))

    def _keep(self, index: int, row: _core.BatchRow) -> None:
        self._folder.record(index, row)
        self._tally.add(index, row)
        if row.failed and not self._keep_going:
            self._tally.exit_code = row.exit_code
            self._stops = True
            self._call_off()

    def _call_off(self) -> None:
        for future in [future for future in self._running if future.cancel()]:
            self._running.pop(future, None)

    def _leave(self, at_once: bool) -> None:
        self._call_off()
        if isinstance(self._engine, WorkerProcesses):
            self._engine.shutdown(wait=not at_once)
        elif not at_once:
            wait(self._running)  # nobody writes any more when the folder is given back

    def _has_own_way(self) -> bool:
        """Whether the batch can go on when a process pool has broken."""
        return isinstance(self._engine, ProcessPoolExecutor | WorkerProcesses)

    def _go_on_without_the_pool(self) -> None:
        """A process pool of Python is of no use any more once one of its processes has died."""
        if not isinstance(self._engine, ProcessPoolExecutor):
            return
        LOGGER.warning("a process of the pool died: the batch goes on with processes of its own")
        self._engine = WorkerProcesses(self._engine._max_workers)  # type: ignore[attr-defined]

    def _how_to_go_on(self) -> str:
        done, total = self._tally.done, self._tally.total
        return f"; {done} of {total} cases are done and kept: mend it, then go on with resume=True"


def _text_of(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"[:LONGEST_MESSAGE]
