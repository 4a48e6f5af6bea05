"""Reading the files of a case directory. What is wrong with one is a ValueError that names file, fault and remedy."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]

REMEDY = "write the directory anew with `crashsim run CASE -o DIR`"
MOST_DIGITS, BEYOND_ALL = 18, 1e100
KINDS = {dict: "an object", list: "a list", str: "a text", bool: "true or false", type(None): "null"}


def fault(where: object, what: str, remedy: str = REMEDY) -> ValueError:
    """The error of a file."""
    return ValueError(f"{where}: {what}: {remedy}")


def read_text(path: Path) -> str:
    """Text of a file. ValueError when it cannot be read or is not UTF-8."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise fault(path, "is not text in UTF-8") from None
    except OSError as error:
        raise fault(path, f"cannot be read ({error.strerror})", "check the file and its permissions") from error


@dataclass(frozen=True)
class Table:
    """Columns of a CSV file in SI units, and its comments."""

    path: Path
    columns: dict[str, Floats]
    comments: dict[str, list[str]]

    def __getitem__(self, name: str) -> Floats:
        """Column `name`. ValueError when there is none."""
        if name not in self.columns:
            raise fault(self.path, f"has no column {name} (it has {', '.join(self.columns)})")
        return self.columns[name]

    def number(self, name: str) -> float | None:
        """Number in the comment `name`, None when there is none."""
        try:
            value = float(self.comments[name][0])
        except (KeyError, ValueError):
            return None
        return value if math.isfinite(value) else None


def read_table(path: Path) -> Table:
    """Reads a CSV file: comments `# name = value`, a line of names, then numbers; an empty cell is no number."""
    comments: dict[str, list[str]] = {}
    lines: list[tuple[int, str]] = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        if line.startswith("#"):
            name, _, value = line[1:].partition("=")
            comments.setdefault(name.strip(), []).append(value.strip())
        elif line.strip():
            lines.append((number, line))
    if len(lines) < 2:
        raise fault(path, "has no line of numbers")
    names = [name.strip() for name in lines[0][1].split(",")]
    values = _numbers(path, lines[1:], len(names))
    return Table(path, dict(zip(names, values.T, strict=True)), comments)


def _numbers(path: Path, lines: list[tuple[int, str]], width: int) -> Floats:
    cells: list[str] = []
    for number, line in lines:
        row = line.split(",")
        if len(row) != width:
            raise fault(f"{path}:{number}", f"has {len(row)} cells, the line of names has {width}")
        cells += row
    try:
        values = np.array([cell or "nan" for cell in cells], dtype=np.float64)
    except ValueError:
        raise fault(*_bad_cell(path, lines)) from None
    return _known(values).reshape(len(lines), width)


def _known(values: Floats) -> Floats:
    """The numbers, NaN where one is beyond all that a crash has: nothing overflows that is made of them."""
    return np.where(np.abs(values) < BEYOND_ALL, values, np.nan)


def _bad_cell(path: Path, lines: list[tuple[int, str]]) -> tuple[str, str]:
    for number, line in lines:
        for cell in line.split(","):
            try:
                float(cell or "nan")
            except ValueError:
                return f"{path}:{number}", f"{cell.strip()[:40]!r} is no number"
    return str(path), "holds something that is no number"


@dataclass(frozen=True)
class Node:
    """An object of a JSON file that checks the kind of what is taken from it."""

    path: Path
    values: dict[str, Any]
    where: str = ""

    def name_of(self, key: str) -> str:
        """Place of `key` in the file, for messages and tables."""
        return f"{self.where}.{key}" if self.where else key

    def _wrong(self, key: str, value: object, expected: str) -> ValueError:
        kind = KINDS.get(type(value), "a number")
        return fault(self.path, f"{self.name_of(key)} is {kind}, must be {expected}")

    def number(self, key: str) -> float | None:
        """A number; None when absent, null or not finite."""
        value = self.values.get(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._wrong(key, value, "a number")
        return float(value) if math.isfinite(value) else None

    def text(self, key: str) -> str:
        """A text; empty when absent or null."""
        value = self.values.get(key)
        if not isinstance(value, str | None):
            raise self._wrong(key, value, "a text")
        return value or ""

    def flag(self, key: str) -> bool | None:
        """True or false; None when absent or null."""
        value = self.values.get(key)
        if not isinstance(value, bool | None):
            raise self._wrong(key, value, "true or false")
        return value

    def node(self, key: str) -> Node | None:
        """An object; None when absent or null."""
        value = self.values.get(key)
        if value is None:
            return None
        if not isinstance(value, dict):
            raise self._wrong(key, value, "an object")
        return Node(self.path, value, self.name_of(key))

    def nodes(self, key: str) -> list[Node]:
        """A list of objects; empty when absent or null."""
        return list(self._objects(key, self._list(key)))

    def _objects(self, key: str, items: list[Any]) -> Iterator[Node]:
        for index, item in enumerate(items):
            if not isinstance(item, dict):
                raise self._wrong(f"{key}[{index}]", item, "an object")
            yield Node(self.path, item, f"{self.name_of(key)}[{index}]")

    def texts(self, key: str) -> list[str]:
        """A list of texts; empty when absent or null."""
        for index, item in enumerate(items := self._list(key)):
            if not isinstance(item, str):
                raise self._wrong(f"{key}[{index}]", item, "a text")
        return items

    def numbers(self, key: str) -> Floats:
        """A list of numbers, NaN where one is null; empty when absent or null."""
        for index, item in enumerate(items := self._list(key)):
            if isinstance(item, bool) or not isinstance(item, int | float | None):
                raise self._wrong(f"{key}[{index}]", item, "a number")
        return _known(np.array(items, dtype=np.float64))

    def _list(self, key: str) -> list[Any]:
        value = self.values.get(key)
        if not isinstance(value, list | None):
            raise self._wrong(key, value, "a list")
        return value or []


def _whole_number(digits: str) -> int | float:
    """A whole number, as float where it has more digits than any that is meant."""
    return int(digits) if len(digits) <= MOST_DIGITS else float(digits)


def read_json(path: Path) -> Node:
    """Reads a JSON file whose top is an object."""
    try:
        value = json.loads(read_text(path), parse_int=_whole_number)
    except json.JSONDecodeError as error:
        raise fault(f"{path}:{error.lineno}", f"is not JSON ({error.msg})") from None
    except RecursionError:
        raise fault(path, "is nested too deeply") from None
    if not isinstance(value, dict):
        raise fault(path, "is not a JSON object")
    return Node(path, value)
