"""Drag of a free disc in a periodic cell. Oracle: the fixed disc, whose drag the cases cylinder_stokes and _inertia judge."""

from pathlib import Path

import pytest

from verification.codes.mappm import Options, run
from verification.measures.observables import drag
from verification.suite.manifest import find_case
from verification.suite.parameters import overrides_of

FREE = ("body.0.motion=free", "body.0.density=10.0", "force.solid=balance")


@pytest.mark.parametrize("name", ["cylinder_stokes.phi_0.2", "cylinder_inertia.phi_0.131_re_20"])
def test_a_free_disc_meets_the_drag_of_a_fixed_one(tmp_path: Path, name: str) -> None:
    case = find_case(name)
    overrides = overrides_of(case, case.base)
    fixed = drag(run(case.file, tmp_path / "fixed", Options(overrides=overrides)))
    free = drag(run(case.file, tmp_path / "free", Options(overrides=overrides + FREE)))
    assert not fixed.objection
    assert not free.objection
    assert abs(free.value / fixed.value - 1) < 0.03
