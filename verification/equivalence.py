"""The matrix of variants that must give the same bits."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from verification.compare import compare
from verification.errors import CaseError
from verification.solver import Options


@dataclass(frozen=True)
class Equivalence:
    steps: int
    every: int
    variants: tuple[str, ...]


@dataclass(frozen=True)
class Matrix:
    equal: bool
    lines: list[str]
    rows: tuple = ()


def read_equivalence(table: dict, where: str) -> Equivalence:
    for key in ("steps", "every", "variants"):
        if key not in table:
            raise CaseError(f"{where}.{key}: missing; add it")
    return Equivalence(table["steps"], table["every"], tuple(table["variants"]))


def run_matrix(scene: Path, equivalence: Equivalence, out: Path, say: Callable[[str], None] = print) -> Matrix:
    overrides = (f"output.sample={equivalence.every}",)
    variants = [
        Options(ranks=0 if text == "serial" else int(text.removeprefix("P=")), steps=equivalence.steps, overrides=overrides)
        for text in equivalence.variants
    ]
    comparison = compare(scene, out, variants)
    return Matrix(comparison.equal, comparison.lines)
