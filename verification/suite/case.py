"""A case as the judge sees it. verification/suite/manifest.py reads it from its folder."""

from dataclasses import dataclass, field
from pathlib import Path

from verification.bits.equivalence import Equivalence

TIERS = ("quick", "full")
REFINED = ("spacing", "step")


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
    explained: str = ""  # why it misses its goal, found out and written down: WRONG all the same, and no reason to stop
    explained_goal: float = 0.0  # largest error, as `goal`, that the explanation covers
    live: str = ""  # quantity of the reference code that is run for this case
    published: str = ""  # table of reference/published
    needs: tuple[str, ...] = ()  # capabilities beside those that the scene asks for
    skipped: str = ""  # why it is not judged: a reference that is not installed, or a code that cannot do it
    unusable: str = ""  # why the reference that there is cannot serve

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
    ratio: float | None
    order: float


@dataclass(frozen=True)
class Live:
    """A reference code that is run for the case, with the options KEY=VALUE of the tier."""

    code: str
    problem: str
    quick: tuple[str, ...]
    full: tuple[str, ...]

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
    equations: tuple[str, ...] = ()
    refined: str = "spacing"
    stalls: str = ""
    observables: tuple[Observable, ...] = ()
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
