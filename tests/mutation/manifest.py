"""The planted faults: tests/mutation/mutants/GROUP.toml.

    [[mutant]]
    id = "viscosity-sign"
    what = "the viscous force drives apart what it should slow down"
    file = "solver/physics/fluid_pair.hpp"
    original = "pressure * r[axis] - friction * pair.v[axis]"
    faulty = "pressure * r[axis] + friction * pair.v[axis]"
    kind = "expression"             # or "statement"; of C++ only
    within = "to_fixed(pressure"    # left out: `original` stands once in the file; else once in this text, which does
    caught_by = ["case shear_wave", "gtest physics/fluid_pair FluidPair.*"]   # see detectors.py
    quick = true                    # left out: false
    hang = true                     # left out: false; a detector that does not end counts as one that failed
"""

import tomllib
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MANIFESTS = Path(__file__).parent / "mutants"
KINDS = ("expression", "statement")
KEYS = {"id": str, "what": str, "file": str, "original": str, "faulty": str, "caught_by": list}
OPTIONAL = {"kind": str, "within": str, "quick": bool, "hang": bool}


class ManifestError(ValueError):
    """An entry that cannot be planted: names the id, the file and what is wrong."""


@dataclass(frozen=True)
class Mutant:
    id: str
    group: str
    what: str
    file: str
    original: str
    faulty: str
    caught_by: tuple[str, ...]
    kind: str = "expression"
    within: str = ""
    quick: bool = False
    hang: bool = False

    @property
    def number(self) -> int:
        """What MAPPM_MUTANT holds to wake this fault; it stays the same when others come and go."""
        return zlib.crc32(self.id.encode()) & 0x7FFFFFFF

    @property
    def is_compiled(self) -> bool:
        return self.file.endswith((".cpp", ".hpp"))

    def span(self, text: str) -> tuple[int, int]:
        """Where `original` stands in the text of its file. Throws ManifestError unless there is one such place."""

        def only(part: str, first: int, last: int, where: str) -> int:
            count = text.count(part, first, last)
            if count != 1:
                raise ManifestError(f"{self.id}: {part!r} stands {count} times in {where}, not once; mend the entry")
            return text.index(part, first, last)

        first, last, where = 0, len(text), self.file
        if self.within:
            first = only(self.within, first, last, where)
            last, where = first + len(self.within), f"its `within` in {self.file}"
        start = only(self.original, first, last, where)
        return start, start + len(self.original)

    def planted(self, text: str) -> str:
        """The text of its file with the fault in it."""
        start, end = self.span(text)
        return text[:start] + self.faulty + text[end:]


def _mutant(table: dict, group: str) -> Mutant:
    name = table.get("id", "an entry without id")
    for key, kind in KEYS.items():
        if not isinstance(table.get(key), kind) or not table[key] and key != "faulty":
            raise ManifestError(f"{name}: {key} is missing or of the wrong type")
    for key, value in table.items():
        if key not in KEYS and not isinstance(value, OPTIONAL.get(key, ())):
            raise ManifestError(f"{name}: {key} is unknown or of the wrong type")
    mutant = Mutant(**table | {"group": group, "caught_by": tuple(table["caught_by"])})
    if mutant.kind not in KINDS:
        raise ManifestError(f"{name}: kind = {mutant.kind!r}: unknown; known are {', '.join(KINDS)}")
    return mutant


def read_manifests(folder: Path = MANIFESTS, root: Path = ROOT) -> list[Mutant]:
    """All faults, each with its place in the sources as they are. Throws ManifestError; it lists all that have none."""
    mutants = [
        _mutant(table, file.stem)
        for file in sorted(folder.glob("*.toml"))
        for table in tomllib.loads(file.read_text())["mutant"]
    ]
    if len({mutant.number for mutant in mutants}) < len(mutants):
        raise ManifestError("two faults share an id, or the number made of it; rename one")
    problems = []
    for mutant in mutants:
        path = root / mutant.file
        try:
            if not path.exists():
                raise ManifestError(f"{mutant.id}: {mutant.file} is missing; mend the entry")
            mutant.span(path.read_text())
        except ManifestError as error:
            problems.append(str(error))
    if problems:
        raise ManifestError("\n".join(problems))
    return mutants


def guarded(text: str, mutants: Iterable[Mutant]) -> str:
    """C++ text in which each fault sleeps until MAPPM_MUTANT names its number. Faults may share their place, or have
    places apart; throws ManifestError where two overlap."""
    places: dict[tuple[int, int], list[Mutant]] = {}
    for mutant in mutants:
        places.setdefault(mutant.span(text), []).append(mutant)
    result, at = "", 0
    for (start, end), here in sorted(places.items(), key=lambda place: place[0]):
        if start < at or len({mutant.kind for mutant in here}) > 1:
            raise ManifestError(f"{here[0].id}: overlaps another fault of {here[0].file} or differs in kind")
        choice = text[start:end]
        for mutant in here:
            wakes = f"::mappm::mutant({mutant.number})"
            if mutant.kind == "expression":
                choice = f"({wakes} ? ({mutant.faulty}) : ({choice}))"
            else:
                choice = f"if ({wakes}) {{ {mutant.faulty} }} else {{ {choice} }}"
        result += text[at:start] + choice
        at = end
    return '#include "base/mutant.hpp"\n' + result + text[at:]
