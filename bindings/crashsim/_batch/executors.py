"""Where the cases of a batch are run: processes of crashsim's own, or an executor that the caller has."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from multiprocessing.connection import wait
from typing import Any

CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
LIBRARIES_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


OWN_FAULTS = {
    signal.SIGSEGV,
    signal.SIGBUS,
    signal.SIGFPE,
    signal.SIGILL,
    signal.SIGABRT,
    signal.SIGSYS,
    signal.SIGTRAP,
}


class WorkerDied(Exception):
    """The process of a worker ended with a task in its hands."""

    def __init__(self, message: str, *, is_late: bool = False, is_own_fault: bool = False) -> None:
        super().__init__(message)
        self.is_late = is_late
        self.is_own_fault = is_own_fault
        """Not a signal from elsewhere."""


def _death(exit_code: int) -> WorkerDied:
    if exit_code >= 0:
        return WorkerDied(f"its process ended in the middle of it: exit code {exit_code}", is_own_fault=True)
    how = f"signal {-exit_code} ({signal.strsignal(-exit_code)})"
    if -exit_code in OWN_FAULTS:
        return WorkerDied(f"its process ended in the middle of it: {how}", is_own_fault=True)
    return WorkerDied(f"its process was killed by {how}")


class WorkerProcesses(Executor):
    """Processes of one task at a time: one that dies takes only the task in its hands with it, and another takes its
    place. They start as new programs, so that neither threads nor the caller's main module matter, and end with this
    process, however it ends."""

    def __init__(self, count: int, time_limit_s: float | None = None, memory_limit_mb: float | None = None) -> None:
        self.count = count or CORES
        self._time_limit_s = time_limit_s
        self._memory_limit_mb = memory_limit_mb
        self._threads = ThreadPoolExecutor(self.count, thread_name_prefix="crashsim-worker")
        self._own = threading.local()
        self._processes: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._is_over = False

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Sends a call to a process; a future of its result."""
        return self._threads.submit(self._run, (fn, args, kwargs))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Ends the processes, after their tasks if `wait`, else at once."""
        if not wait:
            with self._lock:
                self._is_over = True
                for process in self._processes:
                    process.kill()
        self._threads.shutdown(wait=True, cancel_futures=cancel_futures or not wait)
        for process in self._processes:
            _end(process)
        self._processes.clear()

    def _run(self, task: tuple[Any, ...]) -> Any:
        process = self._process()
        try:
            pickle.dump(task, process.stdin)
            process.stdin.flush()
            if not wait([process.stdout], self._time_limit_s):
                self._bury(process)
                limit = f"took longer than the time limit of {self._time_limit_s:g} s: give it more, or ask for less"
                raise WorkerDied(limit, is_late=True)
            error, result = pickle.load(process.stdout)
        except (OSError, EOFError, pickle.UnpicklingError):
            raise _death(self._bury(process)) from None
        if error is not None:
            raise error
        return result

    def _process(self) -> Any:
        """That of this thread; a new one when there is none."""
        process = getattr(self._own, "process", None)
        if process is None:
            with self._lock:
                if self._is_over:
                    raise WorkerDied("its process was ended")
                process = self._own.process = self._start()
                self._processes.add(process)
        return process

    def _start(self) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "crashsim._batch.worker", str(self._memory_limit_mb or "")]
        environment = {**os.environ, **dict.fromkeys(LIBRARIES_THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)}
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)

    def _bury(self, process: subprocess.Popen[bytes]) -> int:
        self._own.process = None
        with self._lock:
            self._processes.discard(process)
        return _end(process)


def _end(process: subprocess.Popen[bytes]) -> int:
    process.kill()
    with contextlib.suppress(BrokenPipeError), process:  # closes its pipes
        pass
    return process.wait()


class RayExecutor(Executor):
    """Ray as an executor: each call is a task of its cluster. Starts Ray on this machine unless it is there already.

    Parameters
    ----------
    **options
        Of ``ray.remote``: ``num_cpus`` (1 unless given), ``resources``, ``max_retries``, ...

    Raises
    ------
    ImportError
        When the package ray is not installed.

    Examples
    --------
    >>> with crashsim.RayExecutor() as ray:  # doctest: +SKIP
    ...     report = crashsim.run_batch("cases.txt", "study", executor=ray)
    """

    def __init__(self, **options: Any) -> None:
        try:
            import ray
        except ImportError as error:
            raise ImportError("RayExecutor needs Ray: pip install ray") from error
        if not ray.is_initialized():
            ray.init()
        self._remote = ray.remote(**{"num_cpus": 1, **options})(_call)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Sends a call to Ray; a future of its result."""
        future: Future[Any] = self._remote.remote(fn, args, kwargs).future()
        return future


def _call(fn: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    return fn(*args, **kwargs)
