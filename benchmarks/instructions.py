"""Counts the instructions of hot paths with callgrind, beside the counts recorded in instructions.json: a regression
shows without a quiet machine. A check that prints, never fails.

Usage: instructions.py BENCH_INSTRUCTIONS [--record]    --record keeps the new counts
valgrind has no AVX-512: what is counted is the code for AVX2.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

RECORDED = pathlib.Path(__file__).with_name("instructions.json")
WORTH_A_WORD = 0.02  # change of a count


def total(program: str, path: str, times: int) -> int:
    run = subprocess.run(
        ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, path, str(times)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    collected = re.search(r"Collected\s*:\s*(\d+)", run.stderr)
    if run.returncode != 0 or collected is None:
        raise SystemExit(f"instructions.py: valgrind {program} {path}: exit code {run.returncode}\n{run.stderr}")
    return int(collected[1])


def count(program: str, path: str) -> int:
    """Instructions of the third time through a path: the first two fill caches and pools."""
    return total(program, path, 3) - total(program, path, 2)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--record", action="store_true")
    given = parser.parse_args()
    paths = subprocess.run([given.program, "--list"], capture_output=True, text=True, check=True).stdout.split()
    recorded = json.loads(RECORDED.read_text()) if RECORDED.exists() else {}
    counts = {path: count(given.program, path) for path in paths}
    for path, now in counts.items():
        before = recorded.get(path)
        change = 0.0 if before is None else now / before - 1.0
        mark = f"  {100 * change:+.1f} %" if abs(change) > WORTH_A_WORD else ""
        print(f"{path:<22} {now:>12,} {'new' if before is None else format(before, ','):>12}{mark}", file=sys.stderr)
        print(json.dumps({"workload": "instructions", "engine": path, "count": now, "recorded": before}))
    if given.record:
        RECORDED.write_text(json.dumps(counts, indent=2) + "\n")


if __name__ == "__main__":
    main()
