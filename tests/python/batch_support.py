"""What the tests of batches share: small cases, and the folders that batches leave behind."""

from __future__ import annotations

import contextlib
import math
import os
import signal
from collections.abc import Callable, Iterable
from pathlib import Path

import support

SIMULATED = '[impact]\nspeed = {speed}\n[crush]\nmodel = "model.json"\n[simulate]\ndt = 0.001\n'
IDENTIFIED = '[pulse]\nfile = "trace.csv"\n[identify]\nstarts = {starts}\nseed = {seed}\n[simulate]\ndt = 0.001\n'
ENDLESS = IDENTIFIED.format(starts=1_000_000, seed=1)


def write_inputs(folder: Path) -> None:
    """A model, and half a sine of 100 ms."""
    (folder / "model.json").write_bytes((support.DATA / "syn-a/model.json").read_bytes())
    rows = ["# mass_kg = 1500\n# impact_speed_mps = 15\ntime_s,accel_g\n"]
    rows += [
        f"{i * 2e-4:.4f},{-27 * math.sin(math.pi * i / 500) if 0 < i < 500 else 0.0:.6g}\n" for i in range(-50, 601)
    ]
    (folder / "trace.csv").write_text("".join(rows), encoding="utf-8")


def write_cases(folder: Path, count: int) -> None:
    """Cases of several kinds: simulated, identified, with numbers that fail, broken."""
    folder.mkdir()
    write_inputs(folder)
    for i in range(count):
        text = SIMULATED.format(speed=10 + 0.25 * i)
        if i % 4 == 1:
            text = IDENTIFIED.format(starts=20, seed=i)
        elif i % 8 == 3:
            text += "end = 0.002\n"
        elif i % 8 == 7:
            text = f"nonsense {i}\n"
        (folder / f"c{i:02d}.toml").write_text(text, encoding="utf-8")


def files_of(folder: Path) -> dict[str, bytes]:
    """Names and bytes of what a batch leaves behind, without what tells times."""
    names = [path for path in folder.rglob("*") if path.is_file() and ".batch" not in path.parts]
    return {str(path.relative_to(folder)): path.read_bytes() for path in names if path.name != "timings.csv"}


def children_of(pid: int) -> list[int]:
    """Processes that a process or one of its threads has started."""
    words: list[str] = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            words += children.read_text().split()
        except OSError:  # the thread is gone
            continue
    return [int(word) for word in words]


def command_of(pid: int) -> bytes:
    """The command line of a process; empty when it is gone."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


class Killer:
    """A progress function that kills a process once some cases are done, `times` times."""

    def __init__(self, victims: Callable[[], Iterable[int]], after: int = 2, times: int = 1) -> None:
        self._victims = victims
        self._after = after
        self._left = times
        self.killed: list[int] = []

    def __call__(self, done: int, total: int) -> None:
        if done < self._after or not self._left:
            return
        for victim in self._victims():
            if victim in self.killed:
                continue
            with contextlib.suppress(ProcessLookupError):
                os.kill(victim, signal.SIGKILL)
                self.killed.append(victim)
                self._left -= 1
                return
