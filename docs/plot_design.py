#!/usr/bin/env python3
"""Draws a design study from its folder: the trade-off curve, the parameters along it, and the sensitivities.

python3 docs/plot_design.py design design.png        (needs matplotlib)
"""

import csv
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # Okabe-Ito
RESPONSES = {  # name of a quantity -> its response, factor and label
    "pitch": ("pitch_max_rad", 57.29577951308232, "largest pitch [deg]"),
    "drop": ("heave_min_m", -1e3, "drop [mm]"),
    "max_crush": ("max_crush_m", 1e3, "maximum crush [mm]"),
    "olc": ("olc_g", 1.0, "occupant load criterion [g]"),
    "peak_decel": ("peak_decel_g", 1.0, "peak deceleration [g]"),
}


def read_table(path):
    """Rows of one of crashsim's CSV files, and its comments."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = file.readlines()
    comments = dict(line[2:].strip().split(" = ", 1) for line in lines if line.startswith("#"))
    return list(csv.DictReader(line for line in lines if not line.startswith("#"))), comments


def draw_curve(axis, rows, comments, result):
    limited, minimised = RESPONSES[comments["limited"]], RESPONSES[comments["minimised"]]
    axis.plot(
        [limited[1] * float(row[limited[0]]) for row in rows],
        [minimised[1] * float(row[minimised[0]]) for row in rows],
        "o-",
        color=COLORS[0],
        label="best under the limit",
    )
    for key, marker, color, label in (("before", "s", "#4d4d4d", "given"), ("after", "*", COLORS[1], "optimum")):
        responses = result[key]
        axis.plot(
            limited[1] * responses[limited[0]],
            minimised[1] * responses[minimised[0]],
            marker,
            ms=11,
            color=color,
            ls="none",
            label=label,
        )
    axis.set(xlabel=limited[2], ylabel=minimised[2], title="Trade-off")
    axis.legend()


def draw_parameters(axis, rows, comments, result):
    limited = RESPONSES[comments["limited"]]
    for color, parameter in zip(COLORS, result["parameters"]):
        lower, upper = parameter["lower"], parameter["upper"]
        axis.plot(
            [limited[1] * float(row[limited[0]]) for row in rows],
            [(float(row[parameter["name"]]) - lower) / (upper - lower) for row in rows],
            "o-",
            color=color,
            label=f"{parameter['name']} ({lower:g} to {upper:g})",
        )
    axis.set(xlabel=limited[2], ylabel="between bounds", ylim=(-0.05, 1.05), title="Parameters along the curve")
    axis.legend(fontsize=7)


def draw_sensitivities(axis, rows):
    parameters = list(dict.fromkeys(row["parameter"] for row in rows))
    responses = list(dict.fromkeys(row["response"] for row in rows))
    height = 0.8 / len(parameters)
    for i, (color, parameter) in enumerate(zip(COLORS, parameters)):
        values = [float(row["percent_per_percent"] or "nan") for row in rows if row["parameter"] == parameter]
        axis.barh(
            [r + (i - (len(parameters) - 1) / 2) * height for r in range(len(responses))],
            values,
            height,
            color=color,
            label=parameter,
        )
    axis.axvline(0, color="0.7", lw=0.8)
    axis.set(yticks=range(len(responses)), yticklabels=responses, xlabel="% per %", title="Sensitivities, given model")
    axis.invert_yaxis()
    axis.legend(fontsize=7)


def main(folder, picture):
    folder = Path(folder)
    result = json.loads((folder / "design.json").read_text(encoding="utf-8"))
    sensitivities, _ = read_table(folder / "sensitivities.csv")
    curve, comments = read_table(folder / "trade_off.csv")
    feasible = [row for row in curve if float(row["feasible"]) == 1.0]
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    draw_curve(axes[0], feasible, comments, result)
    draw_parameters(axes[1], feasible, comments, result)
    draw_sensitivities(axes[2], sensitivities)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:3])
