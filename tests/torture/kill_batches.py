"""Kills batches at random times until they are done: python kill_batches.py PROGRAM [--kills 100] [--seed 1].

Kills the program, one of its workers or all at once by SIGKILL, goes on with --resume, and compares the files with
those of a batch that nobody disturbed. Ends with status 1 at the first difference, and leaves the folders to look at.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mixed_cases import write_cases


def files_of(folder: Path) -> dict[str, bytes]:
    """Names and bytes of what a batch leaves behind, without what tells times."""
    names = [path for path in folder.rglob("*") if path.is_file() and ".batch" not in path.parts]
    return {str(path.relative_to(folder)): path.read_bytes() for path in names if path.name != "timings.csv"}


def batch(program: str, manifest: Path, out: Path) -> list[str]:
    """The command line."""
    return [program, "batch", str(manifest), "-o", str(out), "--resume", "--keep-going", "--quiet"]


def workers_of(pid: int) -> list[int]:
    """Processes of a program."""
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def kill(pid: int, dice: random.Random) -> str:
    """Kills the program, or a worker, or the program and then all its workers. A killed worker leaves it running."""
    victim = dice.choice(("program", "program", "worker", "all"))
    workers = workers_of(pid)
    doomed = {"program": [pid], "worker": [dice.choice(workers or [pid])], "all": [pid, *workers]}[victim]
    for process in doomed:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    return victim


def main() -> None:
    """Kills until it has killed enough."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, default=150)
    given = parser.parse_args()
    dice = random.Random(given.seed)
    folder = Path(tempfile.mkdtemp(prefix="crashsim-torture-"))
    manifest = write_cases(folder / "cases", given.cases)
    begin = time.perf_counter()
    subprocess.run(batch(given.program, manifest, folder / "calm"), check=False)
    calm_s = time.perf_counter() - begin
    expected = files_of(folder / "calm")
    kills = {"program": 0, "worker": 0, "all": 0}
    finished = 0
    out = folder / "out"
    while sum(kills.values()) < given.kills or out.exists():
        process = subprocess.Popen(batch(given.program, manifest, out))
        spared = sum(kills.values()) >= given.kills
        try:
            status = process.wait(None if spared else dice.uniform(0.0, calm_s / 2))
        except subprocess.TimeoutExpired:
            kills[kill(process.pid, dice)] += 1
            status = process.wait()
        if status < 0:
            continue
        if files_of(out) != expected:
            sys.exit(f"kill_batches.py: {out} differs from {folder / 'calm'} after {kills}")
        finished += 1
        shutil.rmtree(out)
    print(f"{sum(kills.values())} kills ({kills}), {finished} batches of {len(expected)} files: all the same bytes")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
