"""What several tests share: the program, and what it writes."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import support

REPOSITORY = Path(__file__).parents[2]
DATA = REPOSITORY / "data"

CaseRunner = Callable[[Path], Path]


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Ctrl-C raises KeyboardInterrupt, also where the tests run in the background of a script, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


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
