"""The program of a worker process: tasks come by standard input, pickled, results go back by standard output.

Usage: python -m crashsim._batch.worker [memory limit in MB]
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import sys
import threading
from typing import Any, BinaryIO

import crashsim  # noqa: F401  (before the limit: importing it is no part of any task)


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes; who waits for the results decides
    results = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a task prints is no result
    if len(sys.argv) > 1 and sys.argv[1]:
        _limit_memory(float(sys.argv[1]))
    tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, tasks), daemon=True).start()
    while True:
        pickle.dump(_result_of(*tasks.get()), results)
        results.flush()


def _listen(source: BinaryIO, tasks: queue.SimpleQueue[Any]) -> None:
    """Ends the process as soon as nobody sends tasks any more, also in the middle of one."""
    while True:
        try:
            tasks.put(pickle.load(source))
        except EOFError:
            os._exit(0)


def _result_of(fn: Any, args: Any, kwargs: Any) -> tuple[Exception | None, Any]:
    try:
        return None, fn(*args, **kwargs)
    except Exception as error:
        return error, None


def _limit_memory(megabytes: float) -> None:
    import resource

    limit = int(1e6 * megabytes)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


if __name__ == "__main__":
    main()
