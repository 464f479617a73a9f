"""A case as the judge sees it. verification/suite/manifest.py reads it from its folder."""

from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

from verification.bits.equivalence import Equivalence

TIERS = ("quick", "full")
REFINED = ("spacing", "step")
EXPLAINS = ("value", "starts", "extrapolated", "all")  # the value of the finest level, the mean of disordered starts, that at dx to 0, each
OTHER = "other"  # chapter of a case that names none
CHAPTERS = ("rest and bits", "waves and decay", "walls", "drag on fixed bodies", "moving bodies", "falling bodies", "contact",
            "the gas-solid system", OTHER)  # of the report, in its order


@dataclass(frozen=True)
class Standard:
    """What an observable had to meet for a time."""

    since: date
    goal: float
    order: tuple[float, float] | None = None
    extrapolated: float | None = None
    why: str = ""  # it was chosen so, where that is told

    def is_looser_than(self, other: "Standard") -> bool:
        """Whether it asks for less in any one point: goal, band, or the goal at dx to 0."""
        def looser(mine: float | None, others: float | None) -> bool:
            return others is not None and (mine is None or mine > others)

        band = other.order is not None and (self.order is None or self.order[0] < other.order[0] or self.order[1] > other.order[1])
        return looser(self.goal, other.goal) or looser(self.extrapolated, other.extrapolated) or band


@dataclass(frozen=True)
class Retired:
    """An observable that is judged no more."""

    name: str
    symbol: str
    standard: Standard  # the last
    earlier: tuple[Standard, ...]
    until: date
    reason: str


@dataclass(frozen=True)
class Observable:
    """What is measured and what it is held against. A reference that is computed or looked up is filled in by references.py."""

    name: str
    symbol: str
    reference: float
    uncertainty: float
    source: str
    goal: float
    input: float = 0.0
    order: tuple[float, float] | None = None
    extrapolated: float | None = None  # goal of the value extrapolated over the levels
    earlier: tuple[Standard, ...] = ()  # the oldest first
    since: date | None = None  # of goal and band
    why: str = ""  # these
    explained: str = ""  # why it misses its goal, found out and written down: FAILED all the same, and no reason to stop
    explains: str = "value"  # which row, one of EXPLAINS
    explained_goal: float = 0.0  # largest error, as `goal`, that the explanation covers
    live: str = ""  # quantity of the reference code that is run for this case
    published: str = ""  # table of reference/published
    code_to_code: bool = False  # the reference is another code with the same law
    points: tuple[str, ...] = ()  # of the case, at which it is judged; all where empty
    needs: tuple[str, ...] = ()  # capabilities beside those that the scene asks for
    skipped: str = ""  # why it is not judged: a reference that is not installed, or a code that cannot do it
    unusable: str = ""  # why the reference that there is cannot serve

    @property
    def standard(self) -> Standard | None:
        """The present one."""
        return None if self.since is None else Standard(self.since, self.goal, self.order, self.extrapolated, self.why)

    @property
    def against(self) -> str:
        """Tells apart observables that share a symbol."""
        return f"{self.symbol} [live]" if self.live else self.symbol


@dataclass(frozen=True)
class Level:
    overrides: tuple[str, ...]  # KEY=VALUE, of parameters and of the scene; parameters.py turns them into overrides of the scene
    tier: str


@dataclass(frozen=True)
class Vary:
    source: str
    sets: tuple[tuple[str, ...], ...]
    ratio: float | None  # None: another choice within a range, or another start
    order: float
    seeds: bool = False  # the sets are other starts, of one distribution
    from_lattice: bool = False  # the run itself is none of these: it starts from a bare lattice


@dataclass(frozen=True)
class Live:
    """A reference code that is run for the case, with the options KEY=VALUE of the tier."""

    code: str
    problem: str
    quick: tuple[str, ...]
    full: tuple[str, ...]
    same_law: bool = False  # as the solver: what it is held against shows programming, not physics

    def options(self, tier: str) -> dict[str, str]:
        return dict(text.split("=", 1) for text in (self.quick if tier == "quick" else self.full))


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
    chapter: str = OTHER
    section: str = ""  # of that chapter, which cases may share; the family where empty
    equations: tuple[str, ...] = ()
    refined: str = "spacing"
    remark: str = ""  # on what the levels show
    observables: tuple[Observable, ...] = ()
    retired: tuple[Retired, ...] = ()
    levels: tuple[Level, ...] = ()
    vary: tuple[Vary, ...] = ()
    beside: tuple[Beside, ...] = ()
    equivalence: Equivalence | None = None
    base: tuple[str, ...] = ()  # what a point sets, with which all its runs begin
    live: Live | None = None
    scene: dict = field(default_factory=dict, repr=False)  # of the case or the point, as it is run
    plain: dict = field(default_factory=dict, repr=False)  # as the file holds it
    parameters: dict = field(default_factory=dict, repr=False)  # name: default
    formulas: dict[str, str] = field(default_factory=dict, repr=False)  # key of the scene, or helper: expression

    @property
    def family(self) -> str:
        """Name of the folder, which the points of a case share."""
        return self.file.parent.name

    @property
    def judged(self) -> bool:
        return bool(self.observables) or self.equivalence is not None or self.live is not None

    def levels_of(self, tier: str) -> list[Level]:
        """From coarse to fine; the scene as it stands where the manifest names none."""
        chosen = [level for level in self.levels if tier == "full" or level.tier == "quick"]
        return chosen or [Level(self.base, "quick")]

    def quick_finest(self) -> Level:
        return self.levels_of("quick")[-1]
