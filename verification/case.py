"""The manifest of a case: the table [case] of cases/NAME/case.toml. A case is that folder and nothing else.

    [case]
    purpose = "one paragraph"
    equations = ["u = U sin(k y) exp(-nu k^2 t)"]   # what the flow obeys, a line each; may be left out
    tier = "quick"                  # or "full"
    cost = 20                       # core-seconds of the quick tier, about
    refined = "spacing"             # or "step": what gets finer from level to level
    stalls = "why the error stops falling"  # only where an observable has no band for its order; may be left out

    [[case.observable]]
    name = "drag"                   # a function of measure.py in the folder of the case, or of verification/observables.py
    symbol = "F/(mu U)"
    reference = 51.53
    uncertainty = 0.005             # standard uncertainty of the reference, absolute
    input = 0.0                     # standard uncertainty from the inputs, absolute; 0 if left out
    source = "Sangani and Acrivos 1982, table 1"
    goal = 0.03                     # largest relative error that can count as correct; absolute where the reference is 0
    order = [1.5, 2.5]              # band of the observed order; may be left out

    [[case.level]]                  # from coarse to fine; `set = []` is the scene as it stands
    set = ["fluid.spacing=0.125", "fluid.rcut=0.375"]
    tier = "full"                   # only in that tier; may be left out

    [[case.vary]]                   # one source of numerical error, changed alone on the finest quick level
    source = "step"                 # step, Mach, disorder, ...
    sets = [["run.step_factor=0.5"]]
    ratio = 2                       # by which the source is refined, and the order of its error: the error is estimated
    order = 1                       # as the change / (1 - ratio^-order). Without ratio: several seeds, their scatter counts

    [[case.beside]]                 # measured and reported, without a verdict
    label = "classic"
    set = ["fluid.method=classic"]

    [case.equivalence]              # see verification/equivalence.py
"""

import os
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from verification.errors import CaseError
from verification.equivalence import Equivalence, read_equivalence
from verification.solver import ROOT

TIERS = ("quick", "full")
REFINED = ("spacing", "step")


def cases_folder() -> Path:
    """Where the cases are: MAPPM_CASES, or cases/ of this tree."""
    return Path(os.environ.get("MAPPM_CASES", ROOT / "cases"))


@dataclass(frozen=True)
class Observable:
    name: str
    symbol: str
    reference: float
    uncertainty: float
    source: str
    goal: float
    input: float = 0.0
    order: tuple[float, float] | None = None


@dataclass(frozen=True)
class Level:
    overrides: tuple[str, ...]
    tier: str


@dataclass(frozen=True)
class Vary:
    source: str
    sets: tuple[tuple[str, ...], ...]
    ratio: float | None
    order: float


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
    equations: tuple[str, ...] = ()
    refined: str = "spacing"
    stalls: str = ""
    observables: tuple[Observable, ...] = ()
    levels: tuple[Level, ...] = ()
    vary: tuple[Vary, ...] = ()
    beside: tuple[Beside, ...] = ()
    equivalence: Equivalence | None = None
    scene: dict = field(default_factory=dict, repr=False)

    @property
    def judged(self) -> bool:
        return bool(self.observables) or self.equivalence is not None

    def levels_of(self, tier: str) -> list[Level]:
        """From coarse to fine; the scene as it stands where the manifest names none."""
        chosen = [level for level in self.levels if tier == "full" or level.tier == "quick"]
        return chosen or [Level((), "quick")]

    def quick_finest(self) -> Level:
        return self.levels_of("quick")[-1]


NUMBER = (int, float)


def _entry(table: dict, key: str, kind: type | tuple[type, ...], where: str, default=None):
    if key not in table:
        if default is None:
            raise CaseError(f"{where}.{key}: missing; add it")
        return default
    if not isinstance(table[key], kind) or isinstance(table[key], bool):
        raise CaseError(f"{where}.{key} = {table[key]!r}: wrong type")
    return table[key]


def _choice(table: dict, key: str, known: tuple[str, ...], where: str, default: str | None = None) -> str:
    value = _entry(table, key, str, where, default)
    if value not in known:
        raise CaseError(f"{where}.{key} = {value!r}: unknown; known are {', '.join(known)}")
    return value


def _only(table: dict, keys: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in keys:
            raise CaseError(f"{where}.{key}: unknown; known are {', '.join(keys)}")


def _texts(table: dict, key: str, where: str, default: list | None = None) -> tuple[str, ...]:
    values = _entry(table, key, list, where, default)
    if not all(isinstance(value, str) for value in values):
        raise CaseError(f"{where}.{key} = {values!r}: write a list of texts")
    return tuple(values)


def _observable(table: dict, where: str) -> Observable:
    kinds = {"name": str, "symbol": str, "reference": NUMBER, "uncertainty": NUMBER, "source": str, "goal": NUMBER}
    _only(table, (*kinds, "input", "order"), where)
    band = table.get("order")
    if band is not None and not (isinstance(band, list) and len(band) == 2 and band[0] < band[1]):
        raise CaseError(f"{where}.order = {band!r}: write the band as [lowest, highest]")
    observable = Observable(
        **{key: _entry(table, key, kind, where) for key, kind in kinds.items()},
        input=_entry(table, "input", NUMBER, where, 0.0),
        order=tuple(band) if band else None,
    )
    if observable.goal < 0 or observable.uncertainty < 0 or observable.input < 0:
        raise CaseError(f"{where}: goal, uncertainty and input must not be negative")
    return observable


def _level(table: dict, where: str) -> Level:
    _only(table, ("set", "tier"), where)
    return Level(_texts(table, "set", where), _choice(table, "tier", TIERS, where, "quick"))


def _vary(table: dict, where: str) -> Vary:
    _only(table, ("source", "sets", "ratio", "order"), where)
    sets = _entry(table, "sets", list, where)
    if not sets or not all(isinstance(entry, list) for entry in sets):
        raise CaseError(f"{where}.sets = {sets!r}: write a list of lists of overrides")
    ratio = table.get("ratio")
    if ratio is not None and (len(sets) != 1 or not isinstance(ratio, NUMBER) or ratio <= 1):
        raise CaseError(f"{where}.ratio = {ratio!r}: needs one entry in sets, and must be above 1")
    if ratio is None and len(sets) < 2:
        raise CaseError(f"{where}.sets: one entry without a ratio says nothing; give the ratio, or several seeds")
    order = _entry(table, "order", NUMBER, where, 1.0)
    return Vary(_entry(table, "source", str, where), tuple(tuple(entry) for entry in sets), ratio, float(order))


def _beside(table: dict, where: str) -> Beside:
    _only(table, ("label", "set"), where)
    return Beside(_entry(table, "label", str, where), _texts(table, "set", where))


def _all_of(table: dict, key: str, read, where: str) -> tuple:
    return tuple(read(entry, f"{where}.{key}[{i}]") for i, entry in enumerate(table.get(key, [])))


def read_case(file: Path) -> Case:
    """Throws CaseError."""
    try:
        scene = tomllib.loads(file.read_text())
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{file}: {error}; mend the TOML") from None
    table = scene.get("case")
    if table is None:
        raise CaseError(f"{file}: case: missing; add a table [case]")
    where = f"{file}: case"
    lists = {"observable": _observable, "level": _level, "vary": _vary, "beside": _beside}
    _only(table, ("purpose", "equations", "tier", "cost", "refined", "stalls", "equivalence", *lists), where)
    found = {key: _all_of(table, key, read, where) for key, read in lists.items()}
    for i, observable in enumerate(found["observable"]):
        if observable.order and len(found["level"]) < 3:
            raise CaseError(f"{where}.observable[{i}].order: an order needs three levels; add [[case.level]]")
    equivalence = table.get("equivalence")
    return Case(
        name=file.parent.name,
        file=file,
        purpose=" ".join(_entry(table, "purpose", str, where).split()),
        tier=_choice(table, "tier", TIERS, where),
        cost=float(_entry(table, "cost", NUMBER, where)),
        equations=_texts(table, "equations", where, []),
        refined=_choice(table, "refined", REFINED, where, "spacing"),
        stalls=" ".join(_entry(table, "stalls", str, where, "").split()),
        observables=found["observable"],
        levels=found["level"],
        vary=found["vary"],
        beside=found["beside"],
        equivalence=None if equivalence is None else read_equivalence(equivalence, f"{where}.equivalence"),
        scene=scene,
    )


def all_cases() -> list[Case]:
    return [read_case(file) for file in sorted(cases_folder().glob("*/case.toml"))]


def find_case(name: str) -> Case:
    """By name, or by the path of its scene."""
    file = Path(name) if name.endswith(".toml") else cases_folder() / name / "case.toml"
    if not file.exists():
        known = ", ".join(path.parent.name for path in sorted(cases_folder().glob("*/case.toml")))
        raise CaseError(f"{name}: no such case; known are {known}")
    return read_case(file)
