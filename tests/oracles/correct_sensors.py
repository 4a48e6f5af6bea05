"""Sensor corrections by brute force: scipy.optimize.least_squares over the common acceleration, sample by sample, and all
corrections at once. Shares no code and no elimination with crashsim.

Usage: correct_sensors.py < problem.json with {"channels": [[..], ..], "dt_s", "first_s", "count", "speed_mps",
"noise_mps2", "correlated_samples", "bias_sd", "gain_sd", "shift_sd", "velocities": [[t, v, sd], ..]}, where channels
start at first_s and the common acceleration has `count` samples from time 0. Prints {"bias", "gain", "shift", "errors"}.
"""

import json
import sys

import numpy as np
from scipy.optimize import least_squares

Array = np.ndarray


def read(values: Array, position: Array) -> Array:
    """The cubic through the four samples around each position, by Lagrange's polynomials."""
    segment = np.clip(np.floor(position).astype(int), 1, len(values) - 3)
    s = position - segment
    basis = (
        -s * (s - 1) * (s - 2) / 6,
        (s + 1) * (s - 1) * (s - 2) / 2,
        -(s + 1) * s * (s - 2) / 2,
        (s + 1) * s * (s - 1) / 6,
    )
    return sum(values[segment + k - 1] * weight for k, weight in enumerate(basis))


def main() -> None:
    p = json.load(sys.stdin)
    channels = [np.array(channel) for channel in p["channels"]]
    n, count, dt = len(channels), p["count"], p["dt_s"]
    grid = np.arange(count) * dt
    sds = np.repeat([p["bias_sd"], p["gain_sd"], p["shift_sd"]], n)
    weight = 1.0 / (p["noise_mps2"] * np.sqrt(p["correlated_samples"]))

    def residuals(unknown: Array) -> Array:
        units, common = unknown[: 3 * n], unknown[3 * n :]
        bias, gain, shift = np.split(units * sds, 3)
        rows = [units]
        for c in range(n):
            measured = read(channels[c], (grid + shift[c] - p["first_s"]) / dt)
            rows.append((measured - bias[c] - (1 + gain[c]) * common) * weight)
        for time, velocity, sd in p["velocities"]:
            k = round(time / dt)
            rows.append([(p["speed_mps"] + np.trapezoid(common[: k + 1], dx=dt) - velocity) / sd])
        return np.concatenate(rows)

    start = np.concatenate([np.zeros(3 * n), np.mean([read(c, (grid - p["first_s"]) / dt) for c in channels], axis=0)])
    found = least_squares(residuals, start, method="trf", x_scale="jac", ftol=1e-14, xtol=1e-14, gtol=1e-14)
    errors = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))[: 3 * n] * sds
    bias, gain, shift = np.split(found.x[: 3 * n] * sds, 3)
    answer = {"bias": bias, "gain": 1 + gain, "shift": shift, "errors": errors}
    json.dump({name: values.tolist() for name, values in answer.items()}, sys.stdout)


if __name__ == "__main__":
    main()
