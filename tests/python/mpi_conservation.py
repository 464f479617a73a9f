"""Mass and momentum are conserved as equalities of integers, over every face between domains.

Oracle: Newton's third law, and the sum over pairs, which the ledger takes apart outside the pass. What the check itself
would see is shown on tables written by hand.
"""

from pathlib import Path

import pytest

from verification.bits.conservation import conservation
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run


@pytest.mark.parametrize(
    ("case", "ranks", "domains", "faces"),
    [
        # Ordered pairs of neighbours at each of 3 samples; across the periodic border too.
        ("crossing_2d", 2, None, 2), ("crossing_2d", 3, None, 6), ("crossing_2d", 4, "2x2", 12),
        ("crossing_3d", 2, None, 2),
    ],
)
def test_faces_and_totals_are_exact(tmp_path: Path, case: str, ranks: int, domains: str | None, faces: int) -> None:
    options = Options(ranks=ranks, domains=domains, steps=150, faces=True, overrides=("output.sample=50",))
    found = conservation(run(ROOT / "cases" / case / "case.toml", tmp_path, options))
    assert found.exact, "\n".join(found.lines)
    assert found.faces == 3 * faces
    assert found.largest_impulse > 2**32  # the equalities are not those of zeros
    assert len(found.momentum) == 4


def test_without_the_option_no_faces_are_written(tmp_path: Path) -> None:
    run(ROOT / "cases" / "crossing_2d" / "case.toml", tmp_path, Options(ranks=2, steps=50))
    assert not (tmp_path / "faces.csv").exists()


SERIES = "step,fluid_particles,momentum_defect_x,momentum_defect_y,digest\n0,9,0,0,00\n5,{count},0,{defect},01\n"
FACES = "step,rank,partner,impulse_x,impulse_y\n5,0,1,{given},7\n5,0,-1,{all},7\n5,1,0,-30,-7\n5,1,-1,-30,-7\n"


@pytest.mark.parametrize(
    ("changed", "kind"),
    [({}, None), ({"count": 8}, "particles"), ({"defect": -1}, "momentum"), ({"all": 31}, "inside"),
     ({"given": 29, "all": 29}, "opposite")],
)
def test_a_single_unit_is_seen(tmp_path: Path, changed: dict[str, int], kind: str | None) -> None:
    values = {"count": 9, "defect": 0, "given": 30, "all": 30} | changed
    (tmp_path / "series.csv").write_text(SERIES.format(**values))
    (tmp_path / "faces.csv").write_text(FACES.format(**values))
    found = conservation(Run(tmp_path))
    defects = {name: getattr(found, name)[5] for name in ("opposite", "inside", "momentum", "particles")}
    assert defects == {name: int(name == kind) for name in defects}
    assert found.exact == (kind is None)
    assert sum(": 1 at step 5" in line for line in found.lines) == int(kind is not None)
