"""One case of a batch as executors see it: a small record goes to a worker, a small answer comes back."""

from __future__ import annotations

import os
import socket
from typing import NamedTuple

from .. import _core


class Task(NamedTuple):
    """What a worker gets: names, no data. Paths mean the same where all see the same file system."""

    name: str
    path: str
    folder: str
    """Of the batch, absolute."""
    start: str
    """Where relative paths start."""
    done: str
    """Row of an earlier run as JSON, or ''."""


class Answer(NamedTuple):
    """What a worker gives back: the case's row as JSON; or the reason why the batch cannot go on."""

    row: str = ""
    unchanged: bool = False
    invalid_input: str = ""
    system_failure: str = ""


NUMBERS_FAILED, MACHINE_FAILED = 3, 4  # exit codes of the program
OUT_OF_MEMORY = "out of memory: give it more, or ask for less"


def work(given: tuple[str, str, str, str, str]) -> tuple[str | bool, ...]:
    """Runs a case in any process. What fails in it is told by the answer: an exception means that a worker failed."""
    return tuple(_answer(Task(*given)))


def _answer(task: Task) -> Answer:
    case = _core.BatchCase(task.name, task.path)
    try:
        _go_to(task)
        if task.done and _core.is_batch_case_done(case, task.folder, _core.batch_row_from_json(task.done)):
            return Answer(unchanged=True)
        return Answer(row=_core.run_batch_case(case, task.folder).to_json())
    except MemoryError:
        return Answer(row=failed_row(task.name, "out_of_memory", MACHINE_FAILED, OUT_OF_MEMORY).to_json())
    except _core.InvalidInput as error:
        return Answer(invalid_input=str(error))
    except OSError as error:
        return Answer(system_failure=str(error))


def _go_to(task: Task) -> None:
    """Sees to it that the paths of a task mean here what they mean where it comes from."""
    if not os.path.isfile(os.path.join(task.folder, "batch.json")):
        raise _core.SystemFailure(
            f"{task.folder}: is not seen by the worker on {socket.gethostname()}: name a folder on a file system that "
            "all workers share"
        )
    if not os.path.isabs(task.path) and os.getcwd() != task.start:
        os.chdir(task.start)


def failed_row(name: str, outcome: str, exit_code: int, message: str) -> _core.BatchRow:
    """The row of a case without results."""
    return _core.BatchRow(name=name, outcome=outcome, exit_code=exit_code, message=message)
