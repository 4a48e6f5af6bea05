"""What the tests of the Python package share."""

from __future__ import annotations

import copy
import json
import os
import pickle
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "data"


def find_program() -> str | None:
    """The executable that CRASHSIM names, else the installed one, else that of the development build."""
    named = os.environ.get("CRASHSIM") or shutil.which("crashsim")
    built = ROOT / "build/dev/apps/crashsim"
    return named or (str(built) if built.is_file() else None)


def program() -> str:
    """The crashsim executable; skips without one."""
    found = find_program()
    if found is None:
        pytest.skip("no program crashsim: install the package, build it, or name it in CRASHSIM")
    return found


def run_program(*arguments: object) -> Any:
    """What the command prints as JSON."""
    command = [program(), *map(str, arguments), "--quiet", "--json"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60)
    return json.loads(done.stdout)


def assert_value(value: Any) -> None:
    """A result is equal to its copies and its pickle, tells what it is, and nobody can change its arrays."""
    for other in (copy.copy(value), copy.deepcopy(value), pickle.loads(pickle.dumps(value)), value.replace()):
        assert other == value
    assert repr(value).startswith(type(value).__name__ + "(")
    assert value != repr(value)
    with pytest.raises(TypeError, match="unhashable"):
        hash(value)
    for name in value._fields:
        field = getattr(value, name)
        with pytest.raises(AttributeError):
            setattr(value, name, field)
        if isinstance(field, np.ndarray):
            assert not field.flags.writeable, name
            with pytest.raises(ValueError, match="read-only"):
                field[...] = 0.0
