"""Rates pairs of curves by the package `objective-rating-metrics`: ISO/TS 18571 by another hand.

Usage: rate_pairs.py < pairs.json, a list of {"reference": [..], "candidate": [..], "dt_s": ..}. Prints a list of
[R, Z, EP, EM, ES].
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
from iso18571_reference import scores  # noqa: E402


def main() -> None:
    pairs = json.load(sys.stdin)
    rated = [scores(np.array(p["reference"]), np.array(p["candidate"]), p["dt_s"]) for p in pairs]
    json.dump(rated, sys.stdout)


if __name__ == "__main__":
    main()
