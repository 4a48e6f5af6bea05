"""Work against precision of the forward runs (W1): time over achieved error of every engine at several tolerances.

Usage: plot.py RESULTS PICTURE    needs matplotlib
"""

import pathlib
import sys

from report import SUNDIALS, engines
from results import read, select


def main() -> None:
    try:
        import matplotlib
    except ImportError as problem:
        raise SystemExit(f"plot.py: skipped: {problem}") from None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    runs = select(read(pathlib.Path(sys.argv[1])), "W1")
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for i, (engine, sundials) in enumerate(engines(runs)):
        if engine.endswith("taylor") and sundials == "system":
            continue  # uses no SUNDIALS
        own = [r for r in runs if r["engine"] == engine and r.get("sundials", "") == sundials]
        own.sort(key=lambda r: r["error"])
        ours = engine.startswith("crashsim")
        label = engine + (f" ({SUNDIALS[sundials]} SUNDIALS)" if "cvode" in engine.lower() and sundials else "")
        axes.loglog(
            [r["error"] for r in own], [1e6 * r["seconds"] for r in own],
            marker="osv^D<>PX*hpd"[i % 13], markersize=4, linewidth=2.2 if ours else 1.0,
            linestyle="-" if ours else "--", color=plt.get_cmap("tab10")(i % 10), label=label,
        )  # fmt: skip
    axes.set_xlabel("achieved error (90 % of models)")
    axes.set_ylabel("CPU time of a run [us]")
    axes.grid(which="major", alpha=0.3)
    axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
