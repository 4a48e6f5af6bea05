"""Throughput and memory of `crashsim batch`: python batch.py PROGRAM [--cases 10000] [--fits 1000] [--shards 4].

Generates cases (simulation and metrics) and identifications, runs them in one batch by 1 process and by all cores, in
shards that are merged, and again with nothing to do; compares the tables and files of all and prints what it took.
"""

import argparse
import filecmp
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
TABLES = ("results.csv", "results.jsonl", "batch.json")
STEP_S = 1e-3  # of outputs: files stay small


@dataclass
class Run:
    """One run of the program and all its processes."""

    seconds: float
    rate: float
    program_mb: float
    """Most memory of the program."""
    worker_mb: float
    """And of its largest worker."""


def half_sine(speed_mps: float) -> str:
    """A trace whose deceleration is half a sine of 100 ms after 10 ms of rest."""
    peak_g = 1.1 * speed_mps * math.pi / 2 / 0.1 / 9.80665
    rows = [f"# mass_kg = 1500\n# impact_speed_mps = {speed_mps:.6g}\ntime_s,accel_g\n"]
    for i in range(-100, 1201):
        accel = -peak_g * math.sin(math.pi * i / 1000) if 0 < i < 1000 else 0.0
        rows.append(f"{i * 1e-4:.4f},{accel:.9g}\n")
    return "".join(rows)


def write_cases(folder: Path, cases: int, fits: int) -> Path:
    """Writes case files and a manifest of them, identifications spread among simulations."""
    folder.mkdir()
    (folder / "model.json").write_bytes((PROJECT / "data/syn-a/model.json").read_bytes())
    names = []
    for i in range(cases):
        names.append(f"sim{i:06d}.toml")
        (folder / names[-1]).write_text(
            f"[impact]\nspeed = {8 + 10 * i / cases:.6f}\n[vehicle]\nmass = {1500 + i % 701}\n[crush]\n"
            f'model = "model.json"\n[simulate]\nto_max_crush = true\ndt = {STEP_S}\n'
        )
    for i in range(fits):
        trace = f"trace{i % 50:02d}.csv"
        if i < 50:
            (folder / trace).write_text(half_sine(10 + 0.1 * i))
        names.append(f"fit{i:06d}.toml")
        (folder / names[-1]).write_text(
            f'[pulse]\nfile = "{trace}"\n[crush]\nspring_knots = {4 + i % 4}\ndamper_knots = {4 + i % 3}\n'
            f"[identify]\nstarts = 4\nseed = {i}\n[simulate]\ndt = {STEP_S}\n"
        )
    names.sort(key=lambda name: name[3:])
    manifest = folder / "cases.txt"
    manifest.write_text("\n".join(names) + "\n")
    return manifest


def peak_mb(pid: int) -> float:
    """Most memory that a process has had; 0 when it is gone."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM")), 0.0)


def children_of(pid: int) -> list[int]:
    """Processes of a process."""
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def run(program: str, *arguments: str) -> Run:
    """Runs the program and watches its memory."""
    begin = time.perf_counter()
    process = subprocess.Popen([program, *arguments, "--json", "--quiet"], stdout=subprocess.PIPE, text=True)
    own = workers = 0.0
    while process.poll() is None:
        own = max(own, peak_mb(process.pid))
        workers = max([workers, *map(peak_mb, children_of(process.pid))])
        time.sleep(0.02)
    seconds = time.perf_counter() - begin
    assert process.stdout is not None
    if process.returncode != 0:
        sys.exit(f"batch.py: crashsim {' '.join(arguments)} ended with status {process.returncode}")
    return Run(seconds, json.load(process.stdout)["total"] / seconds, own, workers)


def same(a: Path, b: Path) -> bool:
    """Whether two batches have the same bytes in their tables and in the files of all cases."""
    if filecmp.cmpfiles(a, b, TABLES, shallow=False)[0] != list(TABLES):
        return False
    files = sorted(path.relative_to(a) for path in (a / "cases").rglob("*") if path.is_file())
    return files == sorted(path.relative_to(b) for path in (b / "cases").rglob("*") if path.is_file()) and all(
        filecmp.cmp(a / name, b / name, shallow=False) for name in files
    )


def show(what: str, done: Run) -> None:
    """One line of the table."""
    memory = f"{done.program_mb:7.1f} MB {done.worker_mb:7.1f} MB"
    print(f"  {what:<44} {done.seconds:8.1f} s {done.rate:7.0f} cases/s {memory}")


def show_memory(program: str, folder: Path, cases: int) -> None:
    """Peak memory at several numbers of cases."""
    print("  simulations only: memory over the number of cases")
    for count in (max(1, cases // 100), max(1, cases // 10), cases):
        manifest = write_cases(folder / f"memory{count}", count, 0)
        show(f"{count} cases", run(program, "batch", str(manifest), "-o", str(folder / f"out{count}")))


def main() -> None:
    """Runs all and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--fits", type=int, default=1_000)
    parser.add_argument("--shards", type=int, default=4)
    given = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory(prefix="crashsim-bench-") as name:
        folder = Path(name)
        print(f"batch of {given.cases} simulations and {given.fits} identifications, {cores} cores")
        print(f"  {'':<44} {'time':>10} {'rate':>15} {'program':>10} {'worker':>10}")
        manifest = str(write_cases(folder / "cases", given.cases, given.fits))
        reference = folder / "one"
        show("1 process", run(given.program, "batch", manifest, "-o", str(reference), "--jobs", "1"))
        show(f"{cores} processes", run(given.program, "batch", manifest, "-o", str(folder / "all")))
        shards = [str(folder / f"shard{i}") for i in range(1, given.shards + 1)]
        parts = [
            run(given.program, "batch", manifest, "-o", shard, "--shard", f"{i}/{given.shards}")
            for i, shard in enumerate(shards, 1)
        ]
        seconds = sum(part.seconds for part in parts)
        rate = (given.cases + given.fits) / seconds
        joined = Run(seconds, rate, max(p.program_mb for p in parts), max(p.worker_mb for p in parts))
        show(f"{given.shards} shards, one after the other", joined)
        show("their merge", run(given.program, "merge", *shards, "-o", str(folder / "merged")))
        show(
            "--resume with nothing to do", run(given.program, "batch", manifest, "-o", str(folder / "all"), "--resume")
        )
        for other in ("all", "merged"):
            if not same(reference, folder / other):
                sys.exit(f"batch.py: the files of '{other}' differ from those of 1 process")
        print("  all of them: the same bytes")
        show_memory(given.program, folder, given.cases)


if __name__ == "__main__":
    main()
