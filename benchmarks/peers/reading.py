"""The readers that a Python user has, on the files of `bench_reading write`: printed as `bench_reading read` does.

Usage: reading.py FOLDER        packages that are not installed are left out, with a word on stderr
"""

import json
import pathlib
import re
import sys
import time
from collections.abc import Callable, Iterable

REPETITIONS = 3


def report(file: str, engine: str, megabytes: float, read: Callable[[], float]) -> None:
    """Times `read`, which returns the sum of all samples, and prints the best of a few."""
    best, checksum = float("inf"), 0.0
    for _ in range(REPETITIONS):
        start = time.perf_counter()
        checksum = float(read())
        best = min(best, time.perf_counter() - start)
    result = {"file": file, "megabytes": megabytes, "seconds": best, "checksum": checksum}
    print(json.dumps({"workload": "reading", "engine": engine, **result}), flush=True)


def size_of(files: Iterable[pathlib.Path]) -> float:
    return sum(file.stat().st_size for file in files) / 1e6


def with_numpy(folder: pathlib.Path) -> None:
    import numpy

    channels = sorted(file for file in folder.glob("v1.*") if re.fullmatch(r"v1\.\d+", file.name))[:200]
    read = lambda: sum(numpy.loadtxt(f)[:, 1].sum() for f in channels)  # noqa: E731
    report("v1.EV5 (200)", "numpy.loadtxt", size_of(channels), read)


def with_pandas(folder: pathlib.Path) -> None:
    import pandas

    channels = sorted(file for file in folder.glob("v1.*") if re.fullmatch(r"v1\.\d+", file.name))[:200]
    read = lambda f: pandas.read_csv(f, sep="\t", header=None, float_precision="round_trip")[1].sum()  # noqa: E731
    report("v1.EV5 (200)", "pandas", size_of(channels), lambda: sum(read(f) for f in channels))
    table = folder / "table.csv"
    read_table = lambda: pandas.read_csv(table, float_precision="round_trip").iloc[:, 1:].to_numpy().sum()  # noqa: E731
    report("table.csv", "pandas", size_of([table]), read_table)


def with_lasso(folder: pathlib.Path) -> None:
    from lasso.dyna import Binout

    def read() -> float:
        binout = Binout(str(folder / "binout0000"))
        names = [name for name in binout.read("nodout") if name.startswith(("x_", "y_", "z_")) or name == "cycle"]
        return sum(binout.read("nodout", name).sum(dtype="float64") for name in names)

    report("binout0000", "lasso-python", size_of([folder / "binout0000"]), read)


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    for read in (with_numpy, with_pandas, with_lasso):
        try:
            read(folder)
        except ImportError as missing:
            print(f"reading.py: left out: {missing}", file=sys.stderr)


main()
