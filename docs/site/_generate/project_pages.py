"""Documents of the project that are pages of the site as they are: the site keeps no copy, links are turned."""

import os
import re
from pathlib import Path

PAGES = {
    "docs/model.md": "theory/model.md",
    "docs/paper.md": "theory/paper.md",
    "docs/formats.md": "reference/formats.md",
    "docs/benchmarks.md": "benchmarks.md",
    "data/README.md": "reference/data.md",
    "CHANGELOG.md": "changelog.md",
}
PROJECT = "project"
"""Folder of the site through which other files of the project are seen."""

LINK = re.compile(r"(?<=\]\()(?![a-z]+:|#)([^)#\s]+)")


def turned(target: str, document: str, source: Path) -> str:
    """Where a document's relative link leads on the site. Raises ValueError when there is no such file."""
    path = os.path.normpath(os.path.join(os.path.dirname(document), target))
    page = PAGES.get(path, os.path.join(PROJECT, path))
    if path not in PAGES and not (source / page).exists():
        raise ValueError(f"{document}: link to {target}: there is no {path}, or script/docs does not link its folder")
    return os.path.relpath(page, os.path.dirname(PAGES[document]))


def page_text(document: str, project: Path, source: Path) -> str:
    """A document with its links turned."""

    def turn(link: re.Match[str]) -> str:
        return turned(link[1], document, source)

    return LINK.sub(turn, (project / document).read_text(encoding="utf-8"))


def write_project_pages(project: Path, source: Path) -> None:
    """Writes the pages of PAGES."""
    for document, page in PAGES.items():
        (source / page).parent.mkdir(parents=True, exist_ok=True)
        (source / page).write_text(page_text(document, project, source), encoding="utf-8")
