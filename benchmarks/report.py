"""Writes the results of script/bench into docs/benchmarks.md: between `<!-- begin NAME -->` and `<!-- end NAME -->`
each table is replaced; what is written around them stays.

Usage: report.py RESULTS PAGE
"""

import pathlib
import re
import sys
from collections.abc import Iterable, Sequence

import targets
from results import Result, fitted_exponents, number, read, seconds_at_error, select

SUNDIALS = {"source": "Release", "system": "packaged", "": ""}
COMPARED_AT = 1e-6  # achieved error at which forward runs are compared


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def microseconds(seconds: float | None) -> str:
    return "-" if seconds is None else number(1e6 * seconds)


def engines(results: Sequence[Result]) -> list[tuple[str, str]]:
    """Engines with their build of SUNDIALS, in the order in which they were measured."""
    return list(dict.fromkeys((r["engine"], r.get("sundials", "")) for r in results))


def ratio(seconds: float | None, base: float | None) -> str:
    return number(seconds / base) if seconds and base else "-"


def forward(results: Sequence[Result]) -> str:
    chosen = select(results, "W1")
    base = seconds_at_error(select(chosen, "W1", "crashsim simulate, taylor", "source"), COMPARED_AT)
    rows = []
    for engine, sundials in engines(chosen):
        runs = [r for r in chosen if r["engine"] == engine and r.get("sundials", "") == sundials]
        usual = next((r for r in runs if r.get("rtol") == 1e-8), runs[0])
        seconds = seconds_at_error(runs, COMPARED_AT)
        key = seconds if seconds is not None else float("inf")
        cells = [engine, SUNDIALS[sundials], microseconds(usual["seconds"]), number(usual["error"], 2)]
        rows.append((key, [*cells, microseconds(seconds), ratio(seconds, base)]))
    header = ["engine", "SUNDIALS", "us at rtol 1e-8", "its error", "us at error 1e-6", "x Taylor"]
    return table(header, (row for _, row in sorted(rows, key=lambda r: r[0])))


def gradient(results: Sequence[Result]) -> str:
    chosen = sorted(select(results, "gradient"), key=lambda r: r["seconds"])
    base = select(chosen, "gradient", "crashsim: E and gradient", "source")
    rows = [
        [r["engine"], SUNDIALS[r.get("sundials", "")], microseconds(r["seconds"]), number(r.get("error"), 2),
         ratio(r["seconds"], base[0]["seconds"] if base else None)]
        for r in chosen
    ]  # fmt: skip
    return table(["engine", "SUNDIALS", "us", "gradient error", "x"], rows)


def fit(results: Sequence[Result]) -> str:
    chosen = sorted(select(results, "W2"), key=lambda r: r["seconds"])
    base = next((r for r in chosen if r["engine"] == "crashsim identify, 100 starts"), None)
    best = min((r["E"] for r in chosen), default=0.0)
    rows = []
    for r in chosen:
        starts = int(r.get("starts", 0))
        said = f"{starts}" if r["engine"].startswith("crashsim") else f"{starts}, to 100 in proportion"
        at_best = r.get("at_best", sum(end <= 1.001 * best for end in r.get("ends", [r["E"]])))
        cells = [r["engine"], SUNDIALS[r.get("sundials", "")], number(r["seconds"]), said, f"{r['E']:.6f}"]
        rows.append([*cells, f"{at_best:.0f}", ratio(r["seconds"], base["seconds"] if base else None)])
    return table(["engine", "SUNDIALS", "CPU s", "starts run", "best E", "within 0.1 % of best", "x"], rows)


def ten_targets(results: Sequence[Result]) -> str:
    rows = [
        [r["engine"], number(r["seconds"]), f"{r['E']:.6f}", f"{r['true_E']:.6f}", f"{r['at_best']:.0f}"]
        for r in sorted(select(results, "targets"), key=lambda r: r["engine"])
    ]
    return table(["", "CPU s", "E", "E of the true model", "starts within 0.1 % of the best"], rows)


def pitch(results: Sequence[Result]) -> str:
    chosen = sorted(select(results, "W3"), key=lambda r: r["seconds"])
    base = select(chosen, "W3", "crashsim simulate_pitch, propagator", "source")
    rows = [
        [r["engine"], SUNDIALS[r.get("sundials", "")], number(r.get("rtol")), microseconds(r["seconds"]),
         number(r["error"], 2), ratio(r["seconds"], base[0]["seconds"] if base else None)]
        for r in chosen
    ]  # fmt: skip
    return table(["engine", "SUNDIALS", "rtol", "us", "error", "x"], rows)


def many(results: Sequence[Result]) -> str:
    rows = [
        [r["engine"], SUNDIALS[r.get("sundials", "")], number(r.get("models")), number(r.get("rtol")),
         microseconds(r["seconds"]), number(r.get("error"), 2)]
        for r in sorted(select(results, "many"), key=lambda r: r["seconds"])
    ]  # fmt: skip
    return table(["engine", "SUNDIALS", "models", "rtol", "us a model", "error"], rows)


def process(results: Sequence[Result]) -> str:
    rows = [[r["engine"], number(1e3 * r["wall"]), number(1e3 * r["seconds"])] for r in select(results, "process")]
    return table(["what", "wall ms", "CPU ms"], rows)


def reading(results: Sequence[Result]) -> str:
    rows = [
        [r["file"], r["engine"], number(r["megabytes"]), number(r["seconds"]), number(r["megabytes"] / r["seconds"]),
         number(r.get("memory"))]
        for r in select(results, "reading")
    ]  # fmt: skip
    return table(["file", "reader", "MB", "s", "MB/s", "peak memory / arrays kept"], rows)


def scaling(results: Sequence[Result]) -> str:
    rows = []
    for what, runs, power in fitted_exponents(results):
        times = ", ".join(f"{r['n']:.0f}: {number(1e3 * r['seconds'])}" for r in runs)
        rows.append([what, times, f"{power:.2f}"])
    return table(["what grows", "CPU ms at each size", "exponent"], rows)


def instructions(results: Sequence[Result]) -> str:
    rows = [
        [r["engine"], f"{r['count']:,}", f"{r['recorded']:,}" if r["recorded"] else "-"]
        for r in select(results, "instructions")
    ]
    return table(["path", "instructions", "recorded"], rows)


def points(results: Sequence[Result]) -> str:
    rows = []
    for target in targets.all_targets(results):
        measured = "not measured" if target.measured is None else number(target.measured, target.digits)
        error = number(target.error, 2) if target.error is not None else ""
        asked = f"{target.relation} {number(target.bound, target.digits)}"
        rows.append([str(target.point), target.what, measured, asked, error, target.verdict()])
    return table(["point", "what", "measured", "asked", "achieved error", ""], rows)


def machine(results: Sequence[Result]) -> str:
    return "\n".join(f"- {r['engine']}: {r['text']}" for r in select(results, "context"))


BLOCKS = (machine, points, forward, gradient, fit, ten_targets, pitch, many, process, reading, scaling, instructions)


def with_block(page: str, name: str, content: str) -> str:
    """The page with the block of this name replaced. A page without it is an error of whoever wrote it."""
    pattern = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
    if not pattern.search(page):
        raise SystemExit(f"report.py: the page has no block '<!-- begin {name} -->' ... '<!-- end {name} -->'")
    return pattern.sub(lambda match: f"{match[1]}\n{content}\n\n{match[2]}", page)


def main() -> None:
    if len(sys.argv) != 3:
        raise SystemExit("usage: report.py RESULTS PAGE")
    results, path = read(pathlib.Path(sys.argv[1])), pathlib.Path(sys.argv[2])
    page = path.read_text()
    for block in BLOCKS:
        content = block(results)
        page = with_block(page, block.__name__, content)
        print(f"\n## {block.__name__}\n\n{content}")
    path.write_text(page)


if __name__ == "__main__":
    main()
