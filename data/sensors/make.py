#!/usr/bin/env python3
"""Writes channels.csv: three accelerometers of one compartment, made up, each wrong in a way that is known.

    python data/sensors/make.py > data/sensors/channels.csv

The vehicle hits at 15 m/s and rebounds at 1.4 m/s after 110 ms. After the impact a channel shows
gain a(t - shift) + bias + noise; the noise is white with 3 m/s^2.
"""

import math

SPEED, REBOUND, DURATION, STEP = 15.0, -1.4, 0.110, 5e-4
CHANNELS = {  # gain, bias [m/s^2] from impact on, shift [s]
    "left_accel_mps2": (1.02, 1.5, 2e-4),
    "right_accel_mps2": (0.99, -2.0, 0.0),
    "tunnel_accel_mps2": (1.00, 0.0, -2e-4),
}


def normal_numbers(seed):
    state = seed
    while True:
        total = -6.0
        for _ in range(12):
            state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
            total += (state >> 11) / 2**53
        yield total


def accel(t):
    s = t / DURATION
    if not 0.0 < s < 1.0:
        return 0.0
    mean = (SPEED - REBOUND) / DURATION
    return -mean * (1.0 - math.cos(2.0 * math.pi * s)) * (1.0 + 0.4 * math.sin(4.0 * math.pi * s))


def main():
    noise = normal_numbers(7)
    print("# title = three accelerometers with known errors (made up)")
    print(f"# impact_speed_mps = {SPEED}")
    print("# mass_kg = 1500")
    print("time_s," + ",".join(CHANNELS))
    for i in range(-80, 321):
        t = i * STEP
        row = [
            gain * accel(t - shift) + (bias if t >= 0.0 else 0.0) + 3.0 * next(noise)
            for gain, bias, shift in CHANNELS.values()
        ]
        print(f"{t:.4f}," + ",".join(f"{value:.4f}" for value in row))


if __name__ == "__main__":
    main()
