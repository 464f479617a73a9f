"""Results that were computed once, on meshes too fine for every day: reference/openfoam/stored, a file for each cell.

A file holds for scenes of its solids fraction, Reynolds number and direction of force, in any units.
"""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from reference.openfoam.cell import SHAPES, Cell
from reference.openfoam.errors import InputError

FOLDER = Path(__file__).parent / "stored"
STOKES = 0.1  # below this Reynolds number inertia counts for less than 4e-5, and one result holds for all
SAME_SOLID, SAME_REYNOLDS, SAME_DIRECTION = 1e-5, 1e-4, 1e-6
AGREEMENT = 1e-4  # between a level run now and the stored one, relative


@dataclass(frozen=True)
class StoredLevel:
    n: int
    value: float
    core_seconds: float
    checksum: str  # SHA-256 of the case files
    uncertainty: float = 0.0  # of a mean over time
    period: float | None = None  # sides over superficial velocity, of a flow that sheds


@dataclass(frozen=True)
class Stored:
    dimension: int
    solid: float
    reynolds: float
    direction: tuple[float, ...]
    transient: bool
    version: str
    command: str
    date: str
    levels: tuple[StoredLevel, ...]  # from coarse to fine

    def fits(self, cell: Cell, transient: bool) -> bool:
        stokes = self.reynolds <= STOKES and cell.reynolds <= 1.01 * STOKES  # as scenes write rounded numbers
        return (
            self.dimension == cell.dimension
            and self.transient == transient
            and abs(self.solid / cell.solid - 1) < SAME_SOLID
            and (stokes or abs(self.reynolds / cell.reynolds - 1) < SAME_REYNOLDS)
            and max(abs(a - b) for a, b in zip(_folded(self.direction), _folded(cell.direction), strict=True))
            < SAME_DIRECTION
        )


def _folded(direction: tuple[float, ...]) -> list[float]:
    """The same for all directions that a square or a cube cannot tell apart."""
    return sorted(abs(component) for component in direction)


def stored_file(cell: Cell, transient: bool = False, folder: Path = FOLDER) -> Path:
    kind = "_transient" if transient else ""
    return folder / f"{SHAPES[cell.dimension]}_phi_{cell.solid:.6g}_re_{cell.reynolds:.6g}{kind}.json"


def read_stored(file: Path) -> Stored:
    """Throws InputError."""
    try:
        data = json.loads(file.read_text())
        data["levels"] = tuple(StoredLevel(**level) for level in data["levels"])
        data["direction"] = tuple(data["direction"])
        return Stored(**data)
    except FileNotFoundError:
        raise InputError(f"--stored {file}: no such file; make it with python3 -m reference.openfoam store") from None
    except (json.JSONDecodeError, KeyError, TypeError) as error:
        raise InputError(f"--stored {file}: {error}; make it again with python3 -m reference.openfoam store") from None


def write_stored(stored: Stored, file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(asdict(stored), indent=1) + "\n")


def find_stored(cell: Cell, transient: bool, file: Path | None) -> Stored:
    """That of `file`, or the one that fits in FOLDER. Throws InputError where none fits."""
    candidates = [read_stored(path) for path in ([file] if file else sorted(FOLDER.glob("*.json")))]
    fitting = [stored for stored in candidates if stored.fits(cell, transient)]
    if fitting:
        return fitting[0]
    raise InputError(
        f"--stored {file or FOLDER}: nothing for a solids fraction of {cell.solid:.6g}, Re {cell.reynolds:.6g} and "
        "this direction; make it with python3 -m reference.openfoam store, or leave --stored out"
    )


def disagreement(stored: Stored, n: int, value: float) -> str:
    """Of a level run now with the stored one; empty where they agree, or the level is not stored.

    A mean over time counts as the same within three of its uncertainties.
    """
    for level in stored.levels:
        allowed = max(AGREEMENT, 3 * level.uncertainty / abs(level.value))
        if level.n == n and abs(value / level.value - 1) > allowed:
            return f"N {n}: {value:.7g} now, {level.value:.7g} in the store, which counts no more: make it again"
    return ""
