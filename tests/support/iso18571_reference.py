#!/usr/bin/env python3
"""Writes tests/verification/iso18571_reference.inc: ISO/TS 18571 scores of synthetic pulse pairs by the Python package
`objective-rating-metrics` (TU Graz), an implementation that shares no code with crashsim.

    pip install objective-rating-metrics scipy
    python tests/support/iso18571_reference.py > tests/verification/iso18571_reference.inc

The pairs are those of rating_pairs.hpp, bit for bit. Rows: seed, sampling interval [s], R, Z, EP, EM, ES.
"""

import argparse

import numpy as np
from objective_rating_metrics.rating import ISO18571

STANDARD_STEP = 1e-4
OTHER_STEPS = [5e-5, 1.25e-4, 2e-4, 7.3e-5]


class Congruential:
    def __init__(self, seed):
        self.state = seed
        for _ in range(8):
            self.next()

    def next(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 11) / 9007199254740992.0

    def between(self, low, high):
        return low + (high - low) * self.next()


def add_noise(values, amplitude, random):
    raw = [random.between(-amplitude, amplitude) for _ in range(len(values) + 4)]
    for i in range(len(values)):
        values[i] = values[i] + (raw[i] + raw[i + 1] + raw[i + 2] + raw[i + 3] + raw[i + 4]) / 5.0


def rating_pair(seed):
    random = Congruential(seed)
    n = int(random.between(120.0, 1600.0))
    scale = random.between(0.6, 1.4)
    shift = random.between(-0.12, 0.12) * n
    stretch = random.between(0.8, 1.25)
    reference, candidate = [0.0] * n, [0.0] * n
    for _ in range(4):
        height = random.between(-400.0, 100.0)
        centre = random.between(0.2, 0.8) * n
        width = random.between(0.1, 0.35) * n
        for i in range(n):
            z = (i - centre) / width
            if z * z < 1.0:
                reference[i] = reference[i] + height * (1.0 - z * z) * (1.0 - z * z)
            y = (i - shift - centre) / (width * stretch)
            if y * y < 1.0:
                candidate[i] = candidate[i] + scale * height * (1.0 - y * y) * (1.0 - y * y)
    add_noise(reference, 10.0, random)
    add_noise(candidate, 10.0, random)
    return np.array(reference), np.array(candidate)


def scores(reference, candidate, dt):
    time = np.arange(len(reference)) * dt
    if dt != STANDARD_STEP:
        grid = np.arange(int(time[-1] / STANDARD_STEP * (1 + 1e-9)) + 1) * STANDARD_STEP
        reference, candidate = np.interp(grid, time, reference), np.interp(grid, time, candidate)
        time = grid
    rating = ISO18571(np.column_stack([time, reference]), np.column_stack([time, candidate]))
    return [
        float(score(ndigits=-1))
        for score in (
            rating.overall_rating,
            rating.corridor_rating,
            rating.phase_rating,
            rating.magnitude_rating,
            rating.slope_rating,
        )
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=40, help="pairs at 10 kHz")
    pairs = parser.parse_args().pairs
    cases = [(seed, STANDARD_STEP) for seed in range(pairs)]
    cases += [(pairs + i, dt) for i, dt in enumerate(OTHER_STEPS * 2)]
    print("// Made by tests/support/iso18571_reference.py: seed, dt_s, R, Z, EP, EM, ES.")
    for seed, dt in cases:
        numbers = ", ".join(repr(score) for score in scores(*rating_pair(seed), dt))
        print(f"{{{seed}, {dt!r}, {numbers}}},")


if __name__ == "__main__":
    main()
