"""Results of script/bench: one JSON object a line, in files named after the part that measured them."""

import itertools
import json
import math
import pathlib
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

Result = dict[str, Any]


def number(value: float | None, digits: int = 3) -> str:
    """As one reads it: significant digits, no exponent for large ones. "-" for None."""
    if value is None:
        return "-"
    text = f"{value:.{digits}g}"
    return text if "e" not in text or abs(value) < 1e-3 else f"{value:.0f}"


def read(folder: pathlib.Path) -> list[Result]:
    """All results; each gets the name of its part."""
    found = []
    for path in sorted(folder.glob("*.jsonl")):
        for line in path.read_text().splitlines():
            found.append({**json.loads(line), "part": path.stem})
    return found


def select(results: Iterable[Result], workload: str, engine: str = "", sundials: str = "") -> list[Result]:
    """Those of a workload whose engine begins so, with that build of SUNDIALS if one is named."""
    return [
        result
        for result in results
        if result["workload"] == workload
        and result["engine"].startswith(engine)
        and (not sundials or result.get("sundials", sundials) == sundials)
    ]


def seconds_at_error(results: Sequence[Result], error: float) -> float | None:
    """Time at which an engine achieves an error, from its runs at several tolerances: the cheapest run that does, or
    between two runs on either side, evenly on logarithmic scales. None when it never does."""
    runs = sorted((r for r in results if r.get("error")), key=lambda r: r["error"])
    good = [r for r in runs if r["error"] <= error]
    if not good:
        return None
    cheapest: float = min(r["seconds"] for r in good)
    for better, worse in itertools.pairwise(runs):
        if better["error"] <= error < worse["error"] and worse["seconds"] < better["seconds"]:
            place = math.log(error / worse["error"]) / math.log(better["error"] / worse["error"])
            between = worse["seconds"] * (better["seconds"] / worse["seconds"]) ** place
            cheapest = min(cheapest, between)
    return cheapest


def exponent(sizes: Sequence[float], seconds: Sequence[float]) -> float:
    """Slope of log(seconds) over log(sizes) by least squares: time grows as size to this power."""
    x, y = [math.log(n) for n in sizes], [math.log(s) for s in seconds]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def fitted_exponents(results: Iterable[Result]) -> Iterator[tuple[str, list[Result], float]]:
    """Each scaling study with its measurements by size, and the exponent of its upper half: what is constant hides the
    growth of small sizes."""
    studies: dict[str, list[Result]] = {}
    for result in select(results, "scaling"):
        studies.setdefault(result["engine"], []).append(result)
    for what, runs in studies.items():
        runs.sort(key=lambda r: r["n"])
        upper = runs[len(runs) // 2 - (len(runs) % 2 == 0) :] if len(runs) > 2 else runs
        yield what, runs, exponent([r["n"] for r in upper], [r["seconds"] for r in upper])
