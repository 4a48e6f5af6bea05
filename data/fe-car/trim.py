#!/usr/bin/env python3
"""Trims an OpenRadioss time history (CSV with named columns) to the columns used here, with units in the header.

    trim.py C40_named.csv C40.csv --speed 11.111

Numbers are copied as they are written; only columns, header and comments change.
"""

import argparse
import csv
import sys

MASS_KG = 1190.017
UNITS = {"D": "mm", "V": "mm/s", "A": "mm/s^2"}
BARRIER = [f"barrier_impulse_{direction}" for direction in ("FNX", "FNZ", "FTX", "FTY", "FTZ")]
NODES = ("LEFT_REAR", "RIGHT_REAR", "LEFT_MID", "RIGHT_MID")


def columns():
    """Pairs of the source's column name and ours with its unit."""
    yield "time_s", "time [s]"
    yield "px_Mg.mm/s", "momentum_x [Mg mm/s]"
    yield "pz_Mg.mm/s", "momentum_z [Mg mm/s]"
    yield "IE_N.mm", "internal_energy [mJ]"
    yield "KE_N.mm", "kinetic_energy [mJ]"
    for name in BARRIER:
        yield f"{name}_N.s", f"{name} [N s]"
    for node in NODES:
        for kind, unit in UNITS.items():
            for axis in "XZ":
                yield f"{node}_{kind}{axis}", f"{node}_{kind}{axis} [{unit}]"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--speed", required=True, help="impact speed in m/s")
    options = parser.parse_args()

    with open(options.source, newline="", encoding="utf-8") as source:
        rows = list(csv.reader(source))
    missing = [name for name, _ in columns() if name not in rows[0]]
    if missing:
        sys.exit(f"{options.source}: no columns {', '.join(missing)}")
    picked = [rows[0].index(name) for name, _ in columns()]

    with open(options.target, "w", newline="", encoding="utf-8") as target:
        target.write(f"# title = finite-element car into a rigid wall at {options.speed} m/s\n")
        target.write("# source = OpenRadioss, computed for this purpose; a test article, not a validated vehicle\n")
        target.write(f"# mass_kg = {MASS_KG}\n# impact_speed_mps = {options.speed}\n")
        writer = csv.writer(target, lineterminator="\n")
        writer.writerow(header for _, header in columns())
        writer.writerows([row[i] for i in picked] for row in rows[1:])


if __name__ == "__main__":
    main()
