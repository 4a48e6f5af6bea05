"""The keys of case, model and vehicle files, from `crashsim schema`."""

import json
import subprocess
from itertools import groupby
from pathlib import Path

from _generate.markdown import code, plain, table

Key = dict[str, str]

TITLES = {
    "case": (
        "Case files",
        "A case file (TOML) is one study. [`crashsim run`](cli/run.md) and [`crashsim design`](cli/design.md) take it. "
        'Quantities take a unit in quotes, `end = "120 ms"`; bare numbers are SI. Paths are relative to the file. '
        "A key that is not listed here is an error that names the nearest one.",
    ),
    "model": ("Model files", "A crush model (JSON), written by [`crashsim identify`](cli/identify.md) or by hand."),
    "vehicle": (
        "Vehicle files",
        "A body on its axles (JSON), for [`crashsim pitch`](cli/pitch.md). In a case file the "
        "same stands in `[vehicle]`.",
    ),
}


def read_schema(program: str, kind: str) -> list[Key]:
    """Keys of a kind of file, in their order."""
    result = subprocess.run([program, "schema", kind, "--json", "--quiet"], capture_output=True, text=True, check=True)
    keys: list[Key] = json.loads(result.stdout)
    return keys


def allowed(key: Key) -> str:
    """Unit, range and choices in one cell."""
    choices = ", ".join(code(choice) for choice in key["choices"].split(", ") if choice)
    return ", ".join(part for part in (plain(key["unit"]), plain(key["range"]), choices) if part)


def schema_page(kind: str, keys: list[Key]) -> str:
    """The page of one kind of file, a table for each section."""
    title, about = TITLES[kind]
    parts = [f"# {title}\n", about + "\n"]
    for section, group in groupby(keys, key=lambda key: key["section"]):
        if section:
            parts.append(f"## [{section}]\n" if kind == "case" else f"## {section}\n")
        rows = [(code(key["key"]), plain(key["doc"]), allowed(key), code(key["default"])) for key in group]
        parts.append(table(("key", "meaning", "unit, values", "default"), rows))
    return "\n".join(parts)


def write_schema_pages(program: str, folder: Path) -> None:
    """Writes case-file.md, model-file.md and vehicle-file.md."""
    for kind in TITLES:
        (folder / f"{kind}-file.md").write_text(schema_page(kind, read_schema(program, kind)), encoding="utf-8")
