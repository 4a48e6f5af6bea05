"""Writes the type stub of the extension from what the extension says of itself.

Usage: write_stub.py <folder of the extension> <stub to write>. Run when the package is built, so that the stub cannot
differ from the code: signatures are pybind11's, types of fields and keyword options come from the tables they are
bound from. What a plain `object` in a signature stands for is said here, by the argument's name.
"""

from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path
from types import ModuleType

HEADER = '''"""The engine of crashsim: written when the package is built."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal, SupportsFloat, SupportsIndex, SupportsInt, overload

import numpy
from numpy.typing import ArrayLike, NDArray

Array = NDArray[numpy.float64]
Path = str | os.PathLike[str]
Number = SupportsFloat | SupportsIndex | str
Names = str | int | Sequence[str | int]
Progress = Callable[[int, int], bool | None]
'''

ARRAYS = [
    "values",
    "time_s",
    "accel_mps2",
    "velocity_mps",
    "displacement_m",
    "force_n",
    "height_m",
    "ax",
    "ay",
    "az",
    "knots",
    "ordinates",
]
NUMBERS = [
    "mass_kg",
    "impact_speed_mps",
    "residual_crush_m",
    "damage_width_m",
    "no_damage_speed_mps",
    "energy_j",
    "cg_position_m",
    "dt_s",
    "start_s",
    "end_s",
]
MOTION = "Pulse | CrushResponse | PitchResponse | CoupledResponse | MeasuredMotion"
FORCE = "PitchForcing | MeasuredForcing | CrushResponse | TimeSeries | Trace | tuple[ArrayLike, ArrayLike]"
OBJECTS = {
    **dict.fromkeys(ARRAYS, "ArrayLike"),
    **dict.fromkeys(NUMBERS, "Number"),
    **dict.fromkeys(("path", "output", "folder", "file"), "Path"),
    "at": "ArrayLike",
    "case": "Case | Path",
    "cases": "Path | Sequence[Path]",
    "channels": "Names",
    "force": FORCE,
    "jobs": "int",
    "key": "str | int",
    "motion": MOTION,
    "progress": "Progress",
    "pulses": "Pulse | Sequence[Pulse]",
    "shards": "Path | Sequence[Path]",
    "vertical_force_n": "TimeSeries | Trace | tuple[ArrayLike, ArrayLike]",
    "weights": "Literal['normalised', 'paper'] | ArrayLike",
}
OF_FUNCTIONS = {  # where a name means something else
    ("rate", "reference"): f"ArrayLike | {MOTION}",
    ("rate", "candidate"): f"ArrayLike | {MOTION}",
    ("errors", "reference"): "ArrayLike",
    ("errors", "candidate"): "ArrayLike",
    ("compare", "reference"): f"TraceSet | {MOTION}",
    ("compare", "candidate"): f"TraceSet | {MOTION}",
    ("compare_metrics", "reference"): f"TraceSet | {MOTION}",
    ("compare_metrics", "candidate"): f"TraceSet | {MOTION}",
    ("check_fleet", "max_crush_m"): "Number | None",
    ("check_fleet", "peak_decel_g"): "Number",
    ("identify_pitch", "target"): "PitchTarget | MeasuredMotion",
    ("identify_vertical", "target"): "VerticalForceTarget | MeasuredVertical",
    ("metrics", "motion"): MOTION,
    ("make_pulse", "time_s"): "TraceSet | ArrayLike",
    ("predict", "model"): "PredictionBasis | Identification | CrushModel | Path",
    ("predict", "speeds"): "Number | Sequence[Number]",
    ("predict", "uncertainty"): "Uncertainty",
    ("uncertainty", "identify"): "Mapping[str, Any]",
    ("write_model", "result"): "CrushModel | Identification",
    ("write_vehicle", "result"): "HeavePitchModel | PitchIdentification",
    ("__contains__", "arg0"): "object",
}
RETURNS = {
    "__getitem__": "Trace",
    "__iter__": "Iterator[str]",
    "keys": "list[str]",
    "select": "list[Trace]",
    "modes": "tuple[Mode, ...]",
    "__call__": "Any",
    "spring_force": "Any",
    "damper_force": "Any",
    "spring_energy": "Any",
    "summary": "dict[str, Any]",
    "parts": "dict[str, dict[str, Any]]",
    "summarize": "dict[str, Any]",
    "find_record": "dict[str, Any] | None",
    "plan_batch": "tuple[BatchCase, ...]",
    "__enter__": "BatchFolder",
}
ADORNED = {"_repr_html_": "str", "to_dataframe": "Any", "plot": "Any"}
OPTION_TYPES = {
    "float or str": "Number",
    "int": "int",
    "bool": "bool",
    "str": "Path",
    "array_like": "ArrayLike",
    "str, int or sequence of them": "Names",
}
SPECIAL = ("__len__", "__getitem__", "__contains__", "__iter__", "__call__", "__enter__", "__exit__")


def main(folder: str, stub: str) -> None:
    sys.path.insert(0, folder)
    core = importlib.import_module("_core")
    Path(stub).write_text(text_of(core), encoding="utf-8")


def text_of(core: ModuleType) -> str:
    """The stub's text."""
    public = {name: getattr(core, name) for name in core.__all__}
    lines = [HEADER, f"__all__ = {list(public)!r}", "__version__: str"]
    lines += [
        f"{name}: {type(value).__name__}" for name, value in public.items() if isinstance(value, (float, str, int))
    ]
    for name, value in public.items():
        if isinstance(value, type):
            lines += ["", *class_lines(name, value)]
        elif callable(value):
            lines += ["", *function_lines(name, value.__doc__ or "", indent="")]
    return "\n".join(lines) + "\n"


def class_lines(name: str, cls: type) -> list[str]:
    if issubclass(cls, BaseException):
        return [f"class {name}({cls.__mro__[1].__name__}): ..."]
    lines = [f"class {name}:", f'    """{(cls.__doc__ or "").splitlines()[0]}"""']
    types: dict[str, str] = getattr(cls, "_field_types", {})
    if types:
        keywords = ", ".join(f"{field}: {given(kind)} = ..." for field, kind in types.items())
        lines += ["    _fields: tuple[str, ...]", f"    def __init__(self, {keywords}) -> None: ..."]
        lines += [f"    def replace(self, *, {keywords}) -> {name}: ..."]
        lines += [f"    def {method}(self, **options: Any) -> {kind}: ..." for method, kind in ADORNED.items()]
    for member, value in vars(cls).items():
        if isinstance(value, property):
            kind = types.get(member) or property_type(value)
            lines += ["    @property", f"    def {member}(self) -> {kind}: ..."]
        elif callable(value) and (is_listed(member) or is_constructor(member, value.__doc__)):
            lines += function_lines(member, value.__doc__ or "", indent="    ")
    return lines


def is_listed(method: str) -> bool:
    return method in SPECIAL or not (method.startswith("_") or method in ADORNED or method == "replace")


def is_constructor(method: str, doc: str | None) -> bool:
    """Whether a method is a constructor with arguments of its own, not those of a value class."""
    return method == "__init__" and "__init__(self: " in (doc or "") and "*args" not in (doc or "")


def given(kind: str) -> str:
    """What a constructor takes for a field of a type."""
    if kind == "float":
        return "Number | None"
    if kind == "TimeSeries":
        return OBJECTS["vertical_force_n"]
    if "Array" in kind or "tuple[float" in kind:
        return f"ArrayLike | {kind}"
    several = re.fullmatch(r"tuple\[(.*), \.\.\.\]", kind)
    return f"Sequence[{several.group(1)}]" if several else kind


def property_type(value: property) -> str:
    found = re.search(r"-> ([\w\[\], .]+)", value.fget.__doc__ or "") if value.fget else None
    return plain(found.group(1)) if found else "Any"


def function_lines(name: str, doc: str, indent: str) -> list[str]:
    signatures = re.findall(rf"^(?:\d+\. )?{re.escape(name)}\((.*)\) -> (.+)$", doc, flags=re.MULTILINE)
    if not signatures:
        raise SystemExit(f"write_stub: {name}: no signature in its docstring")
    options = option_keywords(doc)
    lines = []
    for arguments, result in signatures:
        if len(signatures) > 1:
            lines.append(f"{indent}@overload")
        lines.append(
            f"{indent}def {name}({signature(name, arguments, options)}) -> {RETURNS.get(name) or plain(result)}: ..."
        )
    return lines


def signature(function: str, arguments: str, options: list[str]) -> str:
    parts = [argument(function, part) for part in split_arguments(arguments)]
    if "**kwargs" in parts:
        taken = {part.split(":")[0] for part in parts}
        star = [] if "*" in parts else ["*"]
        named = [option for option in options if option.split(":")[0] not in taken]
        parts = [part for part in parts if part != "**kwargs"] + (star + named if named else [])
    return ", ".join(parts)


def split_arguments(text: str) -> list[str]:
    """At commas outside brackets and quotes."""
    return [part.strip() for part in re.findall(r"(?:[^,\[('\"]|\[[^\]]*\]|\([^)]*\)|'[^']*'|\"[^\"]*\")+", text)]


def argument(function: str, text: str) -> str:
    if text == "*args":
        return "*args: object"
    found = re.fullmatch(r"(\w+): (.+?)(?: = (.+))?", text)
    if found is None or found.group(1) == "self":
        return text.split(":")[0]
    name, kind, default = found.groups()
    if kind == "object":
        known = OF_FUNCTIONS.get((function, name)) or OBJECTS.get(name)
        if known is None:
            raise SystemExit(f"write_stub: {function}({name}: object): say in write_stub.py what it is")
        kind = known
    if default is None:
        return f"{name}: {plain(kind)}"
    return f"{name}: {plain(kind)}{' | None' if default == 'None' else ''} = ..."


def option_keywords(doc: str) -> list[str]:
    """The keywords that a docstring lists under "Other Parameters"."""
    _, _, section = doc.partition("Other Parameters\n----------------\n")
    found = re.findall(r"^(\w+) : (.+), optional$", section, flags=re.MULTILINE)
    return [f"{name}: {option_type(kind)} | None = ..." for name, kind in found]


def option_type(kind: str) -> str:
    choices, _, other = kind.partition(" or array_like")
    if choices.startswith("{"):
        literal = f"Literal[{choices[1:-1]}]"
        return f"{literal} | ArrayLike" if kind != choices else literal
    return OPTION_TYPES[kind + other]


def plain(kind: str) -> str:
    """A type of pybind11's signatures in the stub's words."""
    kind = kind.replace("crashsim._core.", "").replace("_core.", "").replace("typing.", "")
    kind = kind.replace("collections.abc.", "")
    kind = re.sub(r"\bdict$", "dict[str, Any]", kind)
    return re.sub(r"\bnumpy\.ndarray\b", "Array", kind)


if __name__ == "__main__":
    main(*sys.argv[1:])
