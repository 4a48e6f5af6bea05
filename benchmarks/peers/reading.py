"""The readers that a Python user has, on the files of `bench_reading write`: same columns as `bench_reading read`.

Usage: reading.py FOLDER        packages that are not installed are left out, with a word on stderr
"""

import pathlib
import re
import sys
import time

REPETITIONS = 3


def report(file, reader, megabytes, read):
    """Times `read`, which returns the sum of all samples, and prints the best of a few."""
    best = float("inf")
    for _ in range(REPETITIONS):
        start = time.perf_counter()
        checksum = read()
        best = min(best, time.perf_counter() - start)
    print(
        f"{file:<12} {reader:<14} {megabytes:8.1f} {best:9.3f} {megabytes / best:8.0f} "
        f"{'':>9} {'':>9} {'':>6}  {checksum:.15g}"
    )


def size_of(files):
    return sum(file.stat().st_size for file in files) / 1e6


def with_numpy(folder):
    import numpy

    channels = sorted(file for file in folder.glob("v1.*") if re.fullmatch(r"v1\.\d+", file.name))[:200]
    report("v1.EV5 (200)", "numpy.loadtxt", size_of(channels), lambda: sum(numpy.loadtxt(f)[:, 1].sum() for f in channels))


def with_pandas(folder):
    import pandas

    channels = sorted(file for file in folder.glob("v1.*") if re.fullmatch(r"v1\.\d+", file.name))[:200]
    read = lambda f: pandas.read_csv(f, sep="\t", header=None, float_precision="round_trip")[1].sum()  # noqa: E731
    report("v1.EV5 (200)", "pandas", size_of(channels), lambda: sum(read(f) for f in channels))
    table = folder / "table.csv"
    read_table = lambda: pandas.read_csv(table, float_precision="round_trip").iloc[:, 1:].to_numpy().sum()  # noqa: E731
    report("table.csv", "pandas", size_of([table]), read_table)


def with_lasso(folder):
    from lasso.dyna import Binout

    def read():
        binout = Binout(str(folder / "binout0000"))
        names = [name for name in binout.read("nodout") if name.startswith(("x_", "y_", "z_")) or name == "cycle"]
        return sum(binout.read("nodout", name).sum(dtype="float64") for name in names)

    report("binout0000", "lasso-python", size_of([folder / "binout0000"]), read)


def main():
    folder = pathlib.Path(sys.argv[1])
    for read in (with_numpy, with_pandas, with_lasso):
        try:
            read(folder)
        except ImportError as missing:
            print(f"reading.py: left out: {missing}", file=sys.stderr)


main()
