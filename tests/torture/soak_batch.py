"""One long batch, watched: python soak_batch.py PROGRAM [--minutes 30].

Runs mixed cases for a time, stops by Ctrl-C, and prints the memory of the program and of its workers. Ends with
status 1 when one grows, or a case ends as it should not.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from kill_batches import workers_of
from mixed_cases import write_cases

LINES = 300_000
MOST_GROWTH_MB = 5.0  # from the fifth after warming up to the last
EXPECTED = {"completed", "no_max_crush", "invalid_input"}


def memory_mb(pid: int) -> float:
    """Resident memory of a process; 0 when it is gone."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
    except OSError:
        return 0.0


def watch(process: subprocess.Popen[bytes], minutes: float) -> list[tuple[float, float]]:
    """Memory of the program and of its largest worker, until it is time to stop."""
    samples = []
    end = time.monotonic() + 60 * minutes
    while time.monotonic() < end and process.poll() is None:
        time.sleep(1)
        samples.append((memory_mb(process.pid), max(map(memory_mb, workers_of(process.pid)), default=0.0)))
    return samples


def growth(values: list[float]) -> tuple[float, float]:
    """Mean of the first fifth after a fifth to warm up, and of the last."""
    fifth = max(1, len(values) // 5)
    first, last = values[fifth : 2 * fifth], values[-fifth:]
    return sum(first) / len(first), sum(last) / len(last)


def main() -> None:
    """Runs, watches, judges."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--minutes", type=float, default=30)
    given = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="crashsim-soak-"))
    manifest = write_cases(folder / "cases", 200, LINES)
    log = folder / "log.jsonl"
    command = [given.program, "batch", str(manifest), "-o", str(folder / "out"), "--keep-going", "--resume", "--quiet"]
    process = subprocess.Popen([*command, "--log-json", str(log)])
    samples = watch(process, given.minutes)
    process.send_signal(signal.SIGINT)
    status = process.wait()
    outcomes: dict[str, int] = {}
    with log.open() as lines:
        for line in lines:
            if '"case_finished"' in line:
                outcome = json.loads(line)["outcome"]
                outcomes[outcome] = outcomes.get(outcome, 0) + 1
    print(f"{sum(outcomes.values())} cases in {given.minutes:g} minutes: {outcomes}")
    grown = False
    for who, values in (("program", [s[0] for s in samples]), ("worker", [s[1] for s in samples])):
        first, last = growth(values)
        grown = grown or last > first + MOST_GROWTH_MB
        print(f"memory of the {who}: {first:.1f} MB early, {last:.1f} MB late, {max(values):.1f} MB at most")
    shutil.rmtree(folder)
    if status != 130 or grown or not outcomes or set(outcomes) - EXPECTED:
        sys.exit(f"soak_batch.py: failed (status {status}, grown {grown})")


if __name__ == "__main__":
    main()
