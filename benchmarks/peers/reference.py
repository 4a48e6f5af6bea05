"""Checks the reference solutions of the workloads by an independent program, and adds gradients of E to W2.

Usage: reference.py FOLDER    needs SciPy. DOP853 at rtol 1e-13, started anew wherever the force has a kink.
"""

import json
from collections.abc import Callable
from typing import Any

import harness
import numpy as np
from harness import Array, Crush

RTOL, ATOL = 1e-13, 1e-15


class Axis:
    """A curve along its whole signed axis. Segment j >= count lies between knots j - count and the next one, the others
    mirror them; inside a segment the curve is one line."""

    def __init__(self, knots: Array, ordinates: Array) -> None:
        self.knots, self.ordinates, self.count = knots, ordinates, len(knots)
        breaks = np.concatenate([-knots[:0:-1], knots])
        self.edges = np.concatenate([[-np.inf], breaks, [np.inf]])

    def locate(self, s: float, direction: float) -> int:
        return int(np.searchsorted(self.edges, s, "right" if direction > 0 else "left")) - 1

    def force(self, segment: int, s: float) -> tuple[float, float, Array]:
        """curve(|s|) s by the line of the segment, its derivative by s and by the ordinates."""
        sign = 1.0 if segment >= self.count else -1.0
        i = segment - self.count if sign > 0 else self.count - 1 - segment
        weights, slopes = np.zeros(self.count), np.zeros(self.count)
        if i == self.count - 1:
            weights[i] = 1.0
        else:
            width = self.knots[i + 1] - self.knots[i]
            weights[i + 1] = (sign * s - self.knots[i]) / width
            weights[i] = 1.0 - weights[i + 1]
            slopes[i], slopes[i + 1] = -sign / width, sign / width
        value = float(weights @ self.ordinates)
        return value * s, value + float(slopes @ self.ordinates) * s, weights * s


def edge_events(axis: Axis, segment: int, index: int) -> list[tuple[Callable[..., float], int]]:
    """Event functions of leaving a segment, with the segment entered."""

    def event(edge: float, direction: int) -> Callable[..., float]:
        def at_edge(_: float, y: Array) -> float:
            return float(y[index] - edge)

        at_edge.terminal = True  # type: ignore[attr-defined]
        at_edge.direction = direction  # type: ignore[attr-defined]
        return at_edge

    edges = ((axis.edges[segment], -1), (axis.edges[segment + 1], 1))
    return [(event(edge, direction), segment + direction) for edge, direction in edges if np.isfinite(edge)]


def simulate(crush: Crush, times: Array, with_sensitivities: bool) -> tuple[Array, Array]:
    """Channels x, v, a at the times, and their derivatives by the ordinates (ordinate, channel, sample)."""
    from scipy.integrate import solve_ivp

    spring, damper = Axis(crush.spring_knots, crush.spring), Axis(crush.damper_knots, crush.damper)
    count = spring.count + damper.count if with_sensitivities else 0
    segments = [spring.locate(0.0, 1.0), damper.locate(crush.speed, -1.0)]

    def rates(y: Array) -> Array:
        fx, fx_by_x, by_k = spring.force(segments[0], y[0])
        fv, fv_by_v, by_c = damper.force(segments[1], y[1])
        rate = np.empty_like(y)
        rate[0], rate[1] = y[1], -(fx + fv) / crush.mass
        if count:
            sx, sv = y[2 : 2 + count], y[2 + count :]
            rate[2 : 2 + count] = sv
            rate[2 + count :] = -(fx_by_x * sx + fv_by_v * sv + np.concatenate([by_k, by_c])) / crush.mass
        return rate

    states, accelerations = np.empty((len(times), 2 + 2 * count)), np.empty((len(times), 2 + 2 * count))
    t, y, done = 0.0, np.zeros(2 + 2 * count), 0
    y[1] = crush.speed
    while done < len(times):
        leaving = [edge_events(axis, segments[i], i) for i, axis in enumerate((spring, damper))]
        flat = [(event, i, entered) for i, events in enumerate(leaving) for event, entered in events]
        run = solve_ivp(
            lambda _, y: rates(y), (t, times[-1]), y, "DOP853", times[done:],
            events=[event for event, _, _ in flat], rtol=RTOL, atol=ATOL,
        )  # fmt: skip
        for state in run.y.T if len(run.t) else ():
            states[done], accelerations[done] = state, rates(state)
            done += 1
        if run.status != 1:
            break
        hit = next(j for j, when in enumerate(run.t_events) if len(when))
        t, y = float(run.t_events[hit][0]), run.y_events[hit][0]
        segments[flat[hit][1]] = flat[hit][2]
    channels = np.array([states[:, 0], states[:, 1], accelerations[:, 1]])
    derivatives = [states[:, 2 : 2 + count].T, states[:, 2 + count :].T, accelerations[:, 2 + count :].T]
    return channels, np.moveaxis(np.array(derivatives), 0, 1)


def check_forward(workload: harness.Forward, models: int) -> float:
    return max(
        harness.largest_error(simulate(model, workload.times, False)[0], reference)
        for model, reference in zip(workload.models[:models], workload.reference)
    )


def gradients(fit: harness.Fit) -> dict[str, Any]:
    """E and its derivatives by the ordinates at the workload's points."""
    largest = np.abs(fit.target).max(axis=1)[:, None]
    values, slopes = [], []
    for point in fit.points:
        channels, derivatives = simulate(fit.crush.with_ordinates(point), fit.times, True)
        values.append(fit.error(channels))
        signs = np.sign(channels - fit.target) / largest / len(fit.times)
        slopes.append((derivatives * signs).sum(axis=(1, 2)).tolist())
    return {"values": values, "gradients": slopes}


def check_pitch(workload: harness.Pitch) -> float:
    """From sample to sample of the forces, between which the system is smooth."""
    from scipy.integrate import solve_ivp

    a, b = workload.system()
    y = np.zeros(4)
    states = [y]
    for i, (t, end) in enumerate(zip(workload.times, workload.times[1:])):
        slope = (workload.forces[i + 1] - workload.forces[i]) / (end - t)
        force = workload.forces[i]
        run = solve_ivp(
            lambda s, y, force=force, slope=slope: a @ y + b @ (force + s * slope),
            (0.0, end - t), y, "DOP853", rtol=RTOL, atol=ATOL,
        )  # fmt: skip
        y = run.y[:, -1]
        states.append(y)
    return harness.largest_error(np.array(states).T, workload.reference)


def main() -> None:
    harness.need("scipy")
    folder, quick = harness.arguments()
    (folder / "w2_gradients.json").write_text(json.dumps(gradients(harness.read_fit(folder))))
    models = 5 if quick else 50
    harness.report("reference", f"W1, {models} models", 0.0, error=check_forward(harness.read_forward(folder), models))
    harness.report("reference", "W3", 0.0, error=check_pitch(harness.read_pitch(folder)))


if __name__ == "__main__":
    main()
