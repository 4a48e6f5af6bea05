"""HTML reports from the files that `crashsim run` writes."""

from __future__ import annotations

import os
from pathlib import Path

from .case import CASE_FILES, PREDICTION_PREFIX, is_case_directory, read_case_directory
from .case_page import case_page
from .comparison import comparison_page, find_cases
from .files import fault

DEFAULT_NAME = "report.html"

__all__ = ["report"]


def report(directory: str | os.PathLike[str], output: str | os.PathLike[str] | None = None) -> Path:
    """Writes the report of a case directory, or of several, as one HTML file that needs no network.

    A directory that `crashsim run` wrote gives figures, ratings, verdict, numbers and record of the case; files
    that are not there leave out their sections. A directory that holds such directories gives a table to compare them.
    The same files give the same bytes. An output that exists is replaced, all at once.

    Args:
        directory: case directory, or a directory of case directories.
        output: file to write; None: `report.html` inside the directory.

    Returns:
        Path of the file written.

    Raises:
        ValueError: the directory is missing or holds no case, a file is malformed, or the output is no place for a
            report; tells which file, what is wrong and the remedy.
        ImportError: Plotly is missing.
        OSError: the output cannot be written.

    Examples:
        >>> import crashsim
        >>> crashsim.report("out/fe-car")  # doctest: +SKIP
        PosixPath('out/fe-car/report.html')
    """
    folder = Path(directory)
    target = folder / DEFAULT_NAME if output is None else Path(output)
    if not folder.is_dir():
        raise fault(folder, "is no directory", "name one that `crashsim run CASE -o DIR` wrote")
    _check_target(target, folder)
    text = _text_of(folder, target)
    _write(target, text)
    return target


def _text_of(folder: Path, target: Path) -> str:
    if is_case_directory(folder):
        return case_page(read_case_directory(folder))
    cases = find_cases(folder)
    if not cases:
        raise fault(
            folder, "holds neither a case nor directories of cases", "write one with `crashsim run CASE -o DIR`"
        )
    return comparison_page(folder, cases, target)


def _check_target(target: Path, folder: Path) -> None:
    if target.is_dir():
        raise fault(target, "is a directory", "name the file to write, such as report.html")
    if not target.parent.is_dir():
        raise fault(target, "its directory does not exist", f"make {target.parent} first")
    is_case_file = target.name in CASE_FILES or target.name.startswith(PREDICTION_PREFIX)
    if is_case_file and target.parent.resolve() == folder.resolve():
        raise fault(target, "is a file of the case", "choose another name, such as report.html")


def _write(target: Path, text: str) -> None:
    """Writes beside the target and renames, so that nobody sees half a report."""
    final = target.resolve()
    beside = final.with_name(f"{final.name}.{os.getpid()}.part")
    try:
        beside.write_text(text, encoding="utf-8", newline="\n")
        beside.replace(final)
    finally:
        beside.unlink(missing_ok=True)
