"""CVODE through scikit-sundae, the right-hand side in Python.

Usage: sundae_peer.py FOLDER [--quick]
"""

import harness
import numpy as np
from harness import Array, Crush


def main() -> None:
    harness.need("sksundae")
    from sksundae.cvode import CVODE

    folder, quick = harness.arguments()
    forward = harness.read_forward(folder)

    def simulate(model: Crush, tolerance: float) -> Array:
        def rate(t: float, y: Array, yp: Array) -> None:
            yp[0] = y[1]
            yp[1] = model.acceleration(y[0], y[1])

        solver = CVODE(rate, method="Adams", rtol=tolerance, atol=tolerance, max_num_steps=100000)
        run = solver.solve(forward.times, np.array([0.0, model.speed]))
        return model.channels(*run.y.T)

    harness.measure_forward(forward, "scikit-sundae CVODE", simulate, 10 if quick else 50)


if __name__ == "__main__":
    main()
