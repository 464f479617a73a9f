"""Mass and momentum of a run, as equalities of integers: in total, and over every face between two domains.

    face(r, s)   impulse that the particles in the domain of r received from those in that of s, in one step
    all(r)       impulse that the pair pass summed for the particles of r in that step

Newton's third law: face(r, s) = -face(s, r), so face(r, r), across a periodic border, is zero. What is inside a domain
cancels, so the faces of r add up to all(r): the pass gave what the faces say, no pair more and none less.
"""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from verification.protocol.ledger import axes_of, defect_line, totals
from verification.protocol.run import Run
from verification.protocol.series import read_table

ALL = -1  # partner of the rows of all(r)

Vector = tuple[int, ...]


@dataclass(frozen=True)
class Conservation:
    """Largest defects, in integers (iota; particles), by sampled step; all are zero in a sound run."""

    opposite: dict[int, int]  # |face(r, s) + face(s, r)| over all pairs
    inside: dict[int, int]  # |sum over s of face(r, s) - all(r)| over all r
    momentum: dict[int, int]  # |total - start - impulse from outside|
    particles: dict[int, int]  # |number of PPs - that of the first sample|
    faces: int  # pairs of different domains, over all samples
    largest_impulse: int  # over all faces: what the equalities are about

    @property
    def exact(self) -> bool:
        defects = (self.opposite, self.inside, self.momentum, self.particles)
        return not any(value for by_step in defects for value in by_step.values())

    @property
    def lines(self) -> list[str]:
        """Figures for people: the first step of every kind of defect, or that there is none."""
        kinds = {
            "face(r, s) + face(s, r)": self.opposite,
            "sum of the faces of r - all(r)": self.inside,
            "momentum - start - impulse": self.momentum,
            "change of the number of PPs": self.particles,
        }
        about = f"{self.faces} faces, impulses up to {self.largest_impulse}"
        return [*(defect_line(name, by_step) for name, by_step in kinds.items()), about]


def _largest(vectors: list[Vector]) -> int:
    return max((abs(component) for vector in vectors for component in vector), default=0)


def _sum(*vectors: Vector) -> Vector:
    return tuple(sum(components) for components in zip(*vectors, strict=True))


def read_faces(path: Path) -> dict[int, dict[tuple[int, int], Vector]]:
    """Impulse by (rank, partner), by step."""
    table = read_table(path)
    impulses = zip(*(map(int, table[name]) for name in axes_of(table, "impulse")), strict=True)
    faces: dict[int, dict[tuple[int, int], Vector]] = defaultdict(dict)
    for step, rank, partner, impulse in zip(table["step"], table["rank"], table["partner"], impulses, strict=True):
        key = int(rank), int(partner)
        if key in faces[int(step)]:
            raise ValueError(f"{path}: step {int(step)} has two rows of rank {key[0]} and partner {key[1]}")
        faces[int(step)][key] = impulse
    return dict(faces)


def _opposite(faces: dict[tuple[int, int], Vector]) -> int:
    """Largest sum of a face and its reverse; a face that only one side knows counts in full."""
    none = tuple(0 for _ in next(iter(faces.values())))
    pairs = [key for key in faces if key[1] != ALL]
    return _largest([_sum(faces[r, s], faces.get((s, r), none)) for r, s in pairs])


def _inside(faces: dict[tuple[int, int], Vector]) -> int:
    defects = []
    for rank in {key[0] for key in faces}:
        total = faces[rank, ALL]
        given = [impulse for (r, partner), impulse in faces.items() if r == rank and partner != ALL]
        defects.append(_sum(tuple(-component for component in total), *given))
    return _largest(defects)


def conservation(run: Run) -> Conservation:
    """Reads series.csv and faces.csv, for which the run was given --faces."""
    momentum, particles = totals(run)
    faces = read_faces(run.folder / "faces.csv")
    missing = set(list(momentum)[1:]) ^ set(faces)
    if missing:
        raise ValueError(f"{run.folder}: series.csv and faces.csv differ in step {min(missing)}")
    between = [
        vector for by_pair in faces.values() for (r, s), vector in by_pair.items() if s not in (r, ALL)
    ]
    return Conservation(
        opposite={step: _opposite(rows) for step, rows in faces.items()},
        inside={step: _inside(rows) for step, rows in faces.items()},
        momentum=momentum,
        particles=particles,
        faces=len(between),
        largest_impulse=_largest(between),
    )
