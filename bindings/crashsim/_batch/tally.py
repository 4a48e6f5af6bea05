"""What a batch has done so far; its report at the end."""

from __future__ import annotations

import heapq
import time

from .. import _core
from .task import NUMBERS_FAILED

INTERRUPTED = 130
LISTED = 10


class Tally:
    """Counts and short lists, however many cases there are."""

    def __init__(self, total: int, left_over: int) -> None:
        self.total = total
        self.done = self.unchanged = self.failed = self.retried = self.exit_code = 0
        self.interrupted = False
        self._left_over = left_over
        self._stages = dict.fromkeys(_core.StageTimes._fields, 0.0)
        self._slowest: list[tuple[float, int, str]] = []
        self._failures: dict[int, _core.BatchRow] = {}
        self._begin = time.monotonic()

    def count(self, index: int, row: _core.BatchRow) -> None:
        self.done += 1
        if not row.failed:
            return
        self.failed += 1
        self._failures[index] = row
        if len(self._failures) > LISTED:
            del self._failures[max(self._failures)]

    def add(self, index: int, row: _core.BatchRow) -> None:
        """A case that was run now."""
        self.count(index, row)
        for stage in self._stages:
            self._stages[stage] += getattr(row.stages, stage)
        heapq.heappush(self._slowest, (row.seconds, -index, row.name))
        if len(self._slowest) > LISTED:
            heapq.heappop(self._slowest)

    def report(self) -> _core.BatchReport:
        exit_code = self.exit_code or (NUMBERS_FAILED if self.failed else 0)
        return _core.BatchReport(
            total=self.total,
            done=self.done,
            unchanged=self.unchanged,
            failed=self.failed,
            retried=self.retried,
            left_over=self._left_over,
            interrupted=self.interrupted,
            seconds=time.monotonic() - self._begin,
            stages=_core.StageTimes(**self._stages),
            slowest=[(name, seconds) for seconds, _, name in sorted(self._slowest, reverse=True)],
            failures=[row for _, row in sorted(self._failures.items())],
            exit_code=INTERRUPTED if self.interrupted else exit_code,
        )
