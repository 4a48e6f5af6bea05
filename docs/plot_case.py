#!/usr/bin/env python3
"""Draws the picture of the README from a case directory: test and model, total force and its parts.

python3 docs/plot_case.py out/fe-car docs/fe-car.png        (needs matplotlib)
"""

import csv
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

G = 9.80665
TEST, MODEL, SPRING, DAMPER = "#4d4d4d", "#0072b2", "#d55e00", "#009e73"  # Okabe-Ito: safe for colour-blind readers


def read_columns(path):
    """Columns of one of crashsim's CSV files by name."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def before(columns, end_s):
    """The samples up to a time."""
    count = sum(t <= end_s for t in columns["time_s"])
    return {name: values[:count] for name, values in columns.items()}


def scaled(values, factor):
    return [factor * value for value in values]


def main(case, picture):
    case = Path(case)
    summary = json.loads((case / "summary.json").read_text(encoding="utf-8"))
    t_m = summary["pulse"]["t_m_s"]
    test = before(read_columns(case / "pulse.csv"), 1.25 * t_m)
    model = before(read_columns(case / "response.csv"), 1.25 * t_m)

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    for columns, color, label, width in ((test, TEST, "test", 2.2), (model, MODEL, "model", 1.4)):
        t = scaled(columns["time_s"], 1e3)
        axes[0].plot(t, scaled(columns["accel_mps2"], 1 / G), color=color, lw=width, label=label)
        axes[1].plot(t, columns["velocity_mps"], color=color, lw=width, label=f"velocity, {label}")
        axes[1].plot(
            t, scaled(columns["displacement_m"], 10), color=color, lw=width, ls="--", label=f"crush x 10, {label}"
        )
    axes[0].set(xlabel="time [ms]", ylabel="acceleration [g]", title="Pulse")
    axes[1].set(xlabel="time [ms]", ylabel="velocity [m/s], 10 x crush [m]", title="Velocity and crush")
    for axis in axes[:2]:
        axis.axvline(1e3 * t_m, color="0.7", lw=0.8, zorder=0)
        axis.legend(loc="best" if axis is axes[0] else "lower left")

    mass = summary["mass_kg"]
    pushing = before(model, t_m)
    measured = before(test, t_m)
    axes[2].plot(
        scaled(measured["displacement_m"], 1e3),
        scaled(measured["accel_mps2"], -mass / 1e3),
        color=TEST,
        lw=2.2,
        label="test, -m a",
    )
    total = [s + d for s, d in zip(pushing["spring_force_n"], pushing["damper_force_n"])]
    crush = scaled(pushing["displacement_m"], 1e3)
    for force, color, label in (
        (total, MODEL, "model, total"),
        (pushing["spring_force_n"], SPRING, "spring"),
        (pushing["damper_force_n"], DAMPER, "damper"),
    ):
        axes[2].plot(crush, scaled(force, 1e-3), color=color, lw=1.4, label=label)
    axes[2].set(xlabel="crush [mm]", ylabel="force [kN]", title="Force over crush")
    axes[2].legend(loc="best")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:3])
