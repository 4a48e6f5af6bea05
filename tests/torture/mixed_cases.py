"""Cases of all kinds, small: simulated, identified, with heave and pitch, failing, broken."""

import math
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

VEHICLE = (
    "[vehicle]\npitch_inertia = 3000\nfront_axle = 1.2\nrear_axle = 1.4\nfront_stiffness = 50000\n"
    "rear_stiffness = 50000\nforce_arm = 0.3\ncg_height = 0.55\nforce_height = 0.4\n[pitch]\nend = 0.1\ndt = 0.001\n"
)


def trace(speed_mps: float) -> str:
    """Half a sine of 100 ms."""
    rows = [f"# mass_kg = 1500\n# impact_speed_mps = {speed_mps}\ntime_s,accel_g\n"]
    rows += [
        f"{i * 2e-4:.4f},{-27 * math.sin(math.pi * i / 500) if 0 < i < 500 else 0.0:.6g}\n" for i in range(-50, 601)
    ]
    return "".join(rows)


def text_of(i: int) -> str:
    """The i-th case."""
    simulated = f'[impact]\nspeed = {8 + 0.01 * (i % 900):.2f}\n[crush]\nmodel = "model.json"\n[simulate]\ndt = 0.001\n'
    kind = i % 10
    if kind == 3:
        return simulated + "end = 0.002\n"  # no maximum crush
    if kind == 5:
        return f"nonsense {i}\n"
    if kind == 6:
        return simulated + VEHICLE
    if kind == 7:
        return f'[pulse]\nfile = "trace.csv"\n[identify]\nstarts = 2\nseed = {i}\n[simulate]\ndt = 0.001\n'
    if kind == 8:
        return simulated + "[predict]\nspeeds = [10, 12]\n"
    return simulated


def write_cases(folder: Path, count: int, lines: int = 0) -> Path:
    """Writes cases and a manifest of `lines` lines that names them again and again; by default each once."""
    folder.mkdir()
    (folder / "model.json").write_bytes((PROJECT / "data/syn-a/model.json").read_bytes())
    (folder / "trace.csv").write_text(trace(15))
    for i in range(count):
        (folder / f"c{i:04d}.toml").write_text(text_of(i))
    manifest = folder / "cases.txt"
    manifest.write_text("".join(f"n{i:07d} = c{i % count:04d}.toml\n" for i in range(lines or count)))
    return manifest
