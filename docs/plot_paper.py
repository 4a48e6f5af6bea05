#!/usr/bin/env python3
"""Draws the figures of the paper from a case directory made of data/paper/case.toml.

python3 docs/plot_paper.py out/paper data/fe-car/C56.csv docs/paper.png        (needs matplotlib)
"""

import csv
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from plot_case import MODEL, TEST, G, before, read_columns, scaled

COUPLED = "#d55e00"
DISTANCE_MM = 846.7  # between the middle and the rear nodes
CG_MM = 647.0  # of the centre of gravity ahead of the rear nodes


def measured_motion(path):
    """Pitch [rad] and vertical velocity of the centre of gravity [m/s] over time [ms] from the nodes of the trace."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = {name.split(" ")[0]: name for name in rows[0]}

    def mean(place, kind):
        sides = [names[f"{side}_{place}_{kind}"] for side in ("LEFT", "RIGHT")]
        return [sum(float(row[side]) for side in sides) / 2 for row in rows]

    time = [1e3 * float(row[names["time"]]) for row in rows]
    pitch = [(rear - middle) / DISTANCE_MM for rear, middle in zip(mean("REAR", "DZ"), mean("MID", "DZ"), strict=True)]
    share = CG_MM / DISTANCE_MM
    velocity = [
        1e-3 * (rear + share * (middle - rear))
        for rear, middle in zip(mean("REAR", "VZ"), mean("MID", "VZ"), strict=True)
    ]
    return time, pitch, velocity


def plot_motion(axes, case, t_m):
    """Figures 6 to 8: acceleration, velocity, displacement."""
    test = before(read_columns(case / "pulse.csv"), 1.25 * t_m)
    model = before(read_columns(case / "response.csv"), 1.25 * t_m)
    channels = (
        ("accel_mps2", 1 / G, "acceleration [g]"),
        ("velocity_mps", 1, "velocity [m/s]"),
        ("displacement_m", 1e3, "displacement [mm]"),
    )
    for axis, (name, factor, label) in zip(axes, channels, strict=True):
        for columns, color, who in ((test, TEST, "finite elements"), (model, MODEL, "model")):
            axis.plot(scaled(columns["time_s"], 1e3), scaled(columns[name], factor), color=color, label=who)
        axis.set(xlabel="time [ms]", ylabel=label)


def plot_curves(axes, case):
    """Figures 9 and 10: k(x) and c(v)."""
    model = json.loads((case / "model.json").read_text(encoding="utf-8"))
    spring, damper = model["spring"], model["damper"]
    axes[0].plot(scaled(spring["knots_m"], 1e3), scaled(spring["ordinates_n_per_m"], 1e-3), "o-", color=MODEL)
    axes[0].set(xlabel="crush [mm]", ylabel="stiffness k [kN/m]")
    axes[1].plot(damper["knots_mps"], scaled(damper["ordinates_ns_per_m"], 1e-3), "o-", color=MODEL)
    axes[1].set(xlabel="velocity [m/s]", ylabel="damping c [kN s/m]")


def plot_pitch(axes, case, trace):
    """Figures 11 and 12: pitch and vertical velocity."""
    time, pitch, velocity = measured_motion(trace)
    phases, coupled = read_columns(case / "pitch.csv"), read_columns(case / "coupled.csv")
    for axis, test, name, factor, label in (
        (axes[0], [57.2958 * angle for angle in pitch], "pitch_rad", 57.2958, "pitch, nose down [deg]"),
        (axes[1], velocity, "heave_velocity_mps", 1, "vertical velocity [m/s]"),
    ):
        axis.plot(time, test, color=TEST, label="finite elements")
        axis.plot(scaled(phases["time_s"], 1e3), scaled(phases[name], factor), color=MODEL, label="two phases")
        axis.plot(scaled(coupled["time_s"], 1e3), scaled(coupled[name], factor), color=COUPLED, label="coupled")
        axis.set(xlabel="time [ms]", ylabel=label)


def main(case, trace, picture):
    case = Path(case)
    t_m = json.loads((case / "summary.json").read_text(encoding="utf-8"))["pulse"]["t_m_s"]
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
    figure, axes = plt.subplots(2, 4, figsize=(14, 6.4), layout="constrained")
    plot_motion(axes.flat[0:3], case, t_m)
    plot_curves(axes.flat[3:5], case)
    plot_pitch(axes.flat[5:7], case, trace)
    for number, axis in enumerate(axes.flat[:7], start=6):
        axis.set_title(f"Figure {number}", loc="left")
        if axis.get_legend_handles_labels()[0]:
            axis.legend()
    axes.flat[7].set_axis_off()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
