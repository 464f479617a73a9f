"""A body of unequal moments of inertia, free in space, keeps its energy, in both programs and with the same bits.

Oracle: conservation. The closed forms of free rotation are in tests/unit/physics/rigid_body.cpp.
"""

from pathlib import Path

import numpy as np

from verification.bits.compare import compare
from verification.codes.mappm import Options

SCENE = Path(__file__).parent / "scenes" / "free_rotation.toml"


def test_a_free_body_keeps_its_energy_over_a_hundred_turns(tmp_path: Path) -> None:
    comparison = compare(SCENE, tmp_path, [Options(ranks=0), Options(ranks=1)])
    assert comparison.equal, "\n".join(comparison.lines)
    for finished in comparison.runs:
        series = finished.series
        energy = series["spin_energy"]
        assert series["step"][-1] == 62832
        assert np.max(np.abs(energy / energy[0] - 1)) < 1e-11  # a rounding or two a step; 1.6 with omega at its start
        for axis in "xyz":
            assert len(set(series["angular_momentum_" + axis])) == 1  # integers that the rotation leaves alone
            assert len(set(series["momentum_" + axis])) == 1
