"""Writes the generated pages: python -m _generate PROGRAM PROJECT SOURCE."""

import sys
from pathlib import Path

from _generate.cli_pages import write_cli_pages
from _generate.project_pages import write_project_pages
from _generate.python_pages import write_python_pages
from _generate.schema_pages import write_schema_pages


def main(program: str, project: Path, source: Path) -> None:
    """Adds them to the folder that Sphinx reads."""
    write_cli_pages(program, source / "reference/cli")
    write_schema_pages(program, source / "reference")
    write_python_pages(source / "reference/python")
    write_project_pages(project, source)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
