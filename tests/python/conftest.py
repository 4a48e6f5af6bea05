"""What several tests share: the program, and what it writes."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import support

REPOSITORY = Path(__file__).parents[2]
DATA = REPOSITORY / "data"

CaseRunner = Callable[[Path], Path]


@pytest.fixture(scope="session")
def program() -> str:
    """Path of the executable `crashsim`."""
    return support.program()


@pytest.fixture(scope="session")
def case_directory(program: str, tmp_path_factory: pytest.TempPathFactory) -> CaseRunner:
    """Runs a case file and gives its directory, made once for all tests: copy it before you change it."""
    made: dict[Path, Path] = {}

    def run(case_file: Path) -> Path:
        if case_file not in made:
            output = tmp_path_factory.mktemp("case") / case_file.stem
            command = [program, "run", str(case_file), "-o", str(output), "--quiet"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            assert done.returncode in (0, 3), done.stderr
            made[case_file] = output
        return made[case_file]

    return run
