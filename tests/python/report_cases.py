"""Case directories for the tests of the report."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from conftest import DATA, CaseRunner

FE_CAR, TWO_SPEEDS, PAPER = DATA / "fe-car/case.toml", DATA / "fe-car/two-speeds.toml", DATA / "paper/case.toml"


def model_only(folder: Path) -> Path:
    """Case file that simulates a model without a test."""
    path = folder / "model-only.toml"
    model = json.dumps(str(DATA / "syn-a/model.json"))
    path.write_text(f'title = "model only"\n[crush]\nmodel = {model}\n[predict]\nspeeds = ["40 km/h"]\n')
    return path


def without_max_crush(folder: Path) -> Path:
    """Case file that ends before maximum crush: a result that failed."""
    path = folder / "too-short.toml"
    model = json.dumps(str(DATA / "syn-a/model.json"))
    path.write_text(f'title = "too short"\n[crush]\nmodel = {model}\n[simulate]\nend = "20 ms"\n')
    return path


def rewrite_json(path: Path, **changes: Any) -> None:
    """Replaces values at the top of a JSON file."""
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def make_batch(folder: Path, case_directory: CaseRunner) -> Path:
    """Directory of five cases: two good ones, one failed, one malformed, one absent."""
    shutil.copytree(case_directory(FE_CAR), folder / "case-2")
    shutil.copytree(case_directory(TWO_SPEEDS), folder / "case-10")
    shutil.copytree(case_directory(without_max_crush(folder)), folder / "failed")
    shutil.copytree(case_directory(FE_CAR), folder / "malformed")
    (folder / "malformed/summary.json").write_text("{")
    (folder / "absent").mkdir()
    return folder
