"""What a run of a reference code leaves for the judge: OUT/result.json, and beside it fields and tables for pictures.

    python3 -m reference.CODE PROBLEM --scene FILE [--set KEY=VALUE]... --out DIR [options of the problem]

A program that is not installed is no error: the result says what is missing, and the judge skips what needs it.
"""

import hashlib
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

RESULT = "result.json"
COVERAGE = 2.0  # k: half widths of intervals are k standard uncertainties


@dataclass(frozen=True)
class Level:
    """One resolution of the reference code."""

    label: str  # "N 32"
    size: float  # of its cells or its step, relative
    value: float
    core_seconds: float
    live: bool = True  # False: taken from the store, not run now


@dataclass(frozen=True)
class Quantity:
    """One figure in the units of the scene; uncertainty is a standard one, absolute."""

    value: float
    uncertainty: float
    levels: tuple[Level, ...] = ()
    order: float | None = None  # observed
    note: str = ""  # how value and uncertainty were made, one sentence
    unit: str = ""  # of the scene, or none


@dataclass(frozen=True)
class Measured:
    """What a measure found of a run: value +- uncertainty, a standard one, and why it cannot be accepted, if so."""

    value: float
    uncertainty: float
    objection: str = ""


@dataclass(frozen=True)
class Result:
    code: str  # "OpenFOAM"
    version: str = ""
    command: str = ""  # makes this result again from the root of the repository
    inputs: str = ""  # SHA-256 of the files the code was given
    quantities: dict[str, Quantity] = field(default_factory=dict)
    objection: str = ""  # why it cannot serve as a reference, if so
    missing: str = ""  # what is not installed, and how to get it; then there are no quantities
    field: str = ""  # a file beside it: .npz with points (n, D) and velocity (n, D), units of the scene, finest level
    table: str = ""  # a file beside it: .csv of curves over time, units in the header


def write_result(result: Result, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / RESULT).write_text(json.dumps(asdict(result), indent=1) + "\n")


def quantity_of(entry: dict) -> Quantity:
    """From JSON, as asdict() of a quantity writes it; what an entry leaves out has its default."""
    return Quantity(**(entry | {"levels": tuple(Level(**level) for level in entry.get("levels", []))}))


def read_result(folder: Path) -> Result:
    data = json.loads((folder / RESULT).read_text())
    return Result(**(data | {"quantities": {name: quantity_of(entry) for name, entry in data["quantities"].items()}}))


def checksum_of(files: list[Path], root: Path) -> str:
    """SHA-256 over names relative to `root` and contents, in the order of names."""
    whole = hashlib.sha256()
    for file in sorted(files):
        whole.update(str(file.relative_to(root)).encode() + b"\0" + file.read_bytes())
    return whole.hexdigest()
