"""Features against cases, from the manifests alone, run or not: what the suite covers, and its holes."""

from collections.abc import Callable
from dataclasses import dataclass

from verification.protocol.capability import CONTACT, FIXED_BODY, FLUID, FREE_BODY, MOVING_BODY, SPACE, WALLS, asked_by
from verification.suite.case import CHAPTERS, Case

Cases = tuple[Case, ...]


def _asks(word: str) -> Callable[[Case], bool]:
    return lambda case: word in asked_by(case.scene)


def _varies(word: str) -> Callable[[Case], bool]:
    return lambda case: any(vary.source == word for vary in case.vary)


def _over_ranks(case: Case) -> bool:
    return case.equivalence is not None and any(variant.options.ranks > 1 for variant in case.equivalence.variants)


FEATURES: dict[str, Callable[[Case], bool]] = {
    "plane": lambda case: not _asks(SPACE)(case),
    "space": _asks(SPACE),
    "fluid": _asks(FLUID),
    "walls": _asks(WALLS),
    "fixed bodies": _asks(FIXED_BODY),
    "moving bodies": _asks(MOVING_BODY),
    "free bodies": _asks(FREE_BODY),
    "contact": _asks(CONTACT),
    "exact reference": lambda case: any(not one.live and not one.published and one.uncertainty == 0 for one in case.observables),
    "published or computed": lambda case: any(one.published or one.uncertainty > 0 for one in case.observables if not one.live),
    "reference code": lambda case: case.live is not None and any(one.live and not one.code_to_code for one in case.observables),
    "code to code": lambda case: any(one.code_to_code for one in case.observables),
    "equal bits": lambda case: case.equivalence is not None,
    "over processes": _over_ranks,
    "three levels": lambda case: len(case.levels) > 2,
    "seeds varied": lambda case: any(vary.seeds for vary in case.vary),
    "step varied": _varies("step"),
    "sound speed varied": _varies("Mach"),
    "quick tier": lambda case: case.tier == "quick",
    "full tier": lambda case: case.tier == "full" or any(level.tier == "full" for level in case.levels),
}
PHYSICS = ("walls", "fixed bodies", "moving bodies", "free bodies", "contact")
SHOWN_BY = ("exact reference", "published or computed", "reference code", "over processes", "seeds varied")
REFERENCES = ("exact reference", "published or computed", "reference code")


@dataclass(frozen=True)
class Covered:
    """A family of cases: which features at least one of its points has."""

    name: str
    chapter: str
    points: int
    features: frozenset[str]
    codes: tuple[str, ...]  # run live


@dataclass(frozen=True)
class Matrix:
    rows: tuple[Covered, ...]
    physics: tuple[str, ...] = PHYSICS

    @property
    def counts(self) -> dict[str, int]:
        return {name: sum(name in row.features for row in self.rows) for name in FEATURES}

    def counts_in(self, dimension: str) -> dict[str, int]:
        return {name: sum({name, dimension} <= row.features for row in self.rows) for name in FEATURES}

    @property
    def empty(self) -> list[str]:
        return [name for name, count in self.counts.items() if not count]

    def missing(self, physics: str, dimension: str) -> list[str]:
        """Ways of showing it that no case has of this physics in plane or space; all where there is no case."""
        return [way for way in SHOWN_BY if not any({physics, dimension, way} <= row.features for row in self.rows)]

    @property
    def without_reference(self) -> list[str]:
        """Families that are held against nothing from outside this code."""
        return [row.name for row in self.rows if not row.features & set(REFERENCES)]


def matrix_of(cases: list[Case]) -> Matrix:
    families: dict[str, list[Case]] = {}
    for case in cases:
        families.setdefault(case.family, []).append(case)
    rows = [Covered(name, points[0].chapter, len(points),
                    frozenset(feature for feature, has in FEATURES.items() if any(map(has, points))),
                    tuple(dict.fromkeys(point.live.code for point in points if point.live)))
            for name, points in families.items()]
    return Matrix(tuple(sorted(rows, key=lambda row: (CHAPTERS.index(row.chapter), row.name))))
