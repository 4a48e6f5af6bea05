"""Times the program as a whole, file to file, and imports, by the clock on the wall.

Usage: process.py CRASHSIM FOLDER [--python PYTHON]... [--quick]    FOLDER: scratch space
Imports are timed in each PYTHON that has the module.
"""

import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence

CAMRY = pathlib.Path("../shared/data/nhtsa-10146/v10146.EV5")


def seconds_of(command: Sequence[str], repetitions: int) -> tuple[float, float]:
    """Medians of wall and CPU time."""
    wall, cpu = [], []
    for _ in range(repetitions):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        wall.append(time.perf_counter() - start)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        if done.returncode != 0:
            raise SystemExit(f"process.py: {' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
    return statistics.median(wall), statistics.median(cpu)


def report(engine: str, wall: float, cpu: float) -> None:
    print(json.dumps({"workload": "process", "engine": engine, "seconds": cpu, "wall": wall}), flush=True)


def measure(engine: str, command: Sequence[str], repetitions: int) -> None:
    report(engine, *seconds_of(command, repetitions))


def measure_import(python: str, module: str, base: str, repetitions: int) -> None:
    """What an import costs beyond that of another module."""
    if subprocess.run([python, "-c", f"import {base}, {module}"], capture_output=True, check=False).returncode != 0:
        print(f"process.py: {python} cannot import {module}: left out", file=sys.stderr)
        return
    (wall, cpu), (base_wall, base_cpu) = (
        seconds_of([python, "-c", f"import {modules}"], repetitions) for modules in (f"{base}, {module}", base)
    )
    report(f"import {module}, beyond {base}", wall - base_wall, cpu - base_cpu)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("crashsim")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--python", action="append", default=[])
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    repetitions = 5 if given.quick else 21
    pulse, model, response = (str(given.folder / name) for name in ("pulse.csv", "model.json", "response.csv"))
    simulate = ["simulate", "data/syn-a/model.json", "-o", response, "--force"]
    measure("crashsim simulate, file to file", [given.crashsim, *simulate], repetitions)
    pulses = {"finite-element car": ["data/fe-car/C56.csv", "--channel", "LEFT_REAR_VX", "--channel", "RIGHT_REAR_VX"]}
    if CAMRY.exists():
        pulses["NHTSA 10146"] = [str(CAMRY)]
    else:
        print(f"process.py: {CAMRY} is not there: left out", file=sys.stderr)
    for name, arguments in pulses.items():
        measure(f"crashsim pulse, {name}", [given.crashsim, "pulse", *arguments, "-o", pulse, "--force"], repetitions)
        measure(
            f"crashsim identify, {name}",
            [given.crashsim, "identify", pulse, "-o", model, "--force"],
            min(repetitions, 7),
        )
    for python in given.python:
        for module, base in (("numpy", "sys"), ("crashsim", "numpy"), ("scipy.integrate", "sys")):
            measure_import(python, module, base, repetitions)


if __name__ == "__main__":
    main()
