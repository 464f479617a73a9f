"""The manifest of a case: the table [case] of cases/NAME/case.toml.

    [case]
    purpose = "one paragraph"
    tier = "quick"                  # or "full"
    cost = 20                       # core-seconds, about

    [[case.observable]]
    name = "drag"                   # a function of verification/observables.py
    symbol = "F/(mu U)"
    reference = 51.53
    uncertainty = 0.005             # of the reference, absolute
    source = "Sangani and Acrivos 1982, table 1"
    goal = 0.03                     # largest relative error that counts as correct

    [[case.beside]]                 # measured and reported, without a verdict
    label = "classic"
    set = ["fluid.method=classic"]
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from verification.solver import ROOT

TIERS = ("quick", "full")


class CaseError(ValueError):
    """A manifest that cannot be used: names file, key and fix."""


@dataclass(frozen=True)
class Observable:
    name: str
    symbol: str
    reference: float
    uncertainty: float
    source: str
    goal: float


@dataclass(frozen=True)
class Beside:
    label: str
    overrides: tuple[str, ...]


@dataclass(frozen=True)
class Case:
    name: str
    file: Path
    purpose: str
    tier: str
    cost: float
    observables: tuple[Observable, ...]
    beside: tuple[Beside, ...]


def _entry(table: dict, key: str, kind: type | tuple[type, ...], where: str):
    if key not in table:
        raise CaseError(f"{where}.{key}: missing; add it")
    if not isinstance(table[key], kind) or isinstance(table[key], bool):
        raise CaseError(f"{where}.{key} = {table[key]!r}: wrong type")
    return table[key]


def _only(table: dict, keys: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in keys:
            raise CaseError(f"{where}.{key}: unknown; known are {', '.join(keys)}")


def _observable(table: dict, where: str) -> Observable:
    kinds = {"name": str, "symbol": str, "reference": (int, float), "uncertainty": (int, float), "source": str,
             "goal": (int, float)}
    _only(table, tuple(kinds), where)
    return Observable(**{key: _entry(table, key, kind, where) for key, kind in kinds.items()})


def _beside(table: dict, where: str) -> Beside:
    _only(table, ("label", "set"), where)
    return Beside(_entry(table, "label", str, where), tuple(_entry(table, "set", list, where)))


def read_case(file: Path) -> Case:
    """Throws CaseError."""
    table = tomllib.loads(file.read_text()).get("case")
    if table is None:
        raise CaseError(f"{file}: case: missing; add a table [case]")
    where = f"{file}: case"
    _only(table, ("purpose", "tier", "cost", "observable", "beside"), where)
    tier = _entry(table, "tier", str, where)
    if tier not in TIERS:
        raise CaseError(f"{where}.tier = {tier!r}: unknown; known are {', '.join(TIERS)}")
    observables = tuple(
        _observable(entry, f"{where}.observable[{i}]") for i, entry in enumerate(table.get("observable", []))
    )
    beside = tuple(_beside(entry, f"{where}.beside[{i}]") for i, entry in enumerate(table.get("beside", [])))
    purpose = " ".join(_entry(table, "purpose", str, where).split())
    cost = _entry(table, "cost", (int, float), where)
    return Case(file.parent.name, file, purpose, tier, cost, observables, beside)


def all_cases() -> list[Case]:
    return [read_case(file) for file in sorted((ROOT / "cases").glob("*/case.toml"))]


def find_case(name: str) -> Case:
    """By name, or by the path of its scene."""
    file = Path(name) if name.endswith(".toml") else ROOT / "cases" / name / "case.toml"
    if not file.exists():
        known = ", ".join(path.parent.name for path in sorted((ROOT / "cases").glob("*/case.toml")))
        raise CaseError(f"{name}: no such case; known are {known}")
    return read_case(file)
