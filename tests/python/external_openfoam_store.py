"""Stored levels of OpenFOAM, computed again. Oracle: the stored value, to the accuracy of the iteration."""

from pathlib import Path

import pytest

from reference.openfoam import store
from reference.openfoam.cell import cell_of
from reference.openfoam.level import run_level
from reference.openfoam.run import missing_of

LACKING = missing_of(("blockMesh", "simpleFoam"))
pytestmark = pytest.mark.skipif(bool(LACKING), reason=LACKING)
SPHERES = 0.064  # solids fraction of the spheres that are tried here; each file is compared again wherever it serves as a reference


def tried(stored: store.Stored) -> bool:
    return not stored.transient and (stored.dimension == 2 or abs(stored.solid - SPHERES) < 1e-3)


STEADY = sorted(file for file in store.FOLDER.glob("*.json") if tried(store.read_stored(file)))


@pytest.mark.parametrize("file", STEADY, ids=lambda file: file.stem)
def test_the_coarsest_stored_level_comes_out_again(tmp_path: Path, file: Path) -> None:
    stored = store.read_stored(file)
    n = stored.levels[0].n
    found = run_level(tmp_path / "level", cell_of(stored.dimension, stored.solid, stored.reynolds), n)
    assert not found.objection
    assert not store.disagreement(stored, n, found.drag)
    assert store.disagreement(stored, n, 1.001 * found.drag)
