"""The same bits on any number of ranks, domains and threads, in the reference and after a restart.

Oracle: the serial reference, another program without MPI, and its all-pairs search, which knows no cells.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.compare import compare_runs
from verification.solver import ROOT, Options, Run, run
from verification.series import Table, read_table

SCENES = Path(__file__).parent / "scenes"
STEPS = 1000


def solids_of(finished: Run) -> Table:
    return read_table(finished.folder / "solids.csv")


def travelled(solids: Table, axis: str, side: float) -> np.ndarray:
    """Distance each solid came along an axis, unwrapped from sample to sample (none moves half a box between two)."""
    ids = np.unique(solids["id"])
    paths = [np.unwrap(solids["position_" + axis][solids["id"] == solid], period=side) for solid in ids]
    return np.array([path[-1] - path[0] for path in paths])


def restarted(scene: Path, folder: Path, before: int, after: int) -> Run:
    """A run stopped at half its steps on `before` ranks and resumed on `after`."""
    overrides = (f"output.checkpoint={STEPS // 2}",)
    run(scene, folder, Options(ranks=before, steps=STEPS // 2, overrides=overrides))
    (checkpoint,) = (folder / "checkpoints").iterdir()
    return run(scene, folder, Options(ranks=after, steps=STEPS, overrides=overrides, resume=checkpoint))


def assert_all_equal(runs: list[Run], samples: int) -> None:
    comparison = compare_runs(tuple(runs))
    assert comparison.equal, "\n".join(comparison.lines)
    assert len(runs[0].series) == samples
    for finished in runs:
        for axis in "xyz"[: len(finished.scene["box"]["size"])]:
            momentum = [int(total) for total in finished.series["momentum_" + axis]]
            impulse = [int(total) for total in finished.series["impulse_" + axis]]
            assert [total - momentum[0] for total in momentum] == impulse  # integers: equal, not close


@pytest.mark.parametrize(
    ("scene", "grids"), [("crossing_2d", ("2x2", "3x1")), ("crossing_3d", ("1x2x2", "2x1x2"))]
)
def test_solids_that_cross_borders_and_turn(tmp_path: Path, scene: str, grids: tuple[str, ...]) -> None:
    variants = [Options(ranks=0), *(Options(ranks=ranks) for ranks in (1, 2, 3, 4))]
    variants += [Options(ranks=math.prod(map(int, grid.split("x"))), domains=grid) for grid in grids]
    variants.append(Options(ranks=2, threads=2))
    if scene == "crossing_2d":  # small enough for all pairs
        variants += [Options(ranks=0, neighbours="all-pairs"), Options(ranks=1, threads=2)]
    file = SCENES / f"{scene}.toml"
    runs = [run(file, tmp_path / str(i), options) for i, options in enumerate(variants)]
    runs.append(restarted(file, tmp_path / "restarted", before=2, after=3))
    assert_all_equal(runs, samples=21)

    # The scene does what it is for: every solid comes further along the slabs than a quarter of the box, the width of
    # one of four, some come further than half of the shorter side, and all have turned.
    solids, box = solids_of(runs[0]), runs[0].scene["box"]["size"]
    long, short = "xyz"[len(box) - 1], "x"
    assert np.all(np.abs(travelled(solids, long, box[-1])) > box[-1] / 4)
    assert np.any(np.abs(travelled(solids, short, box[0])) > box[0] / 2)
    upright = "orientation_cos" if len(box) == 2 else "orientation_w"
    assert np.all(solids[upright][solids["step"] == STEPS] < 0.999)


@pytest.mark.parametrize(
    ("scene", "grid"), [("fields_2d", "2x2"), ("fields_3d", "1x2x2"), ("cavity", "2x2")]
)
def test_fields_disorder_and_walls_of_two_directions(tmp_path: Path, scene: str, grid: str) -> None:
    variants = [Options(ranks=ranks) for ranks in (0, 1, 2, 3, 4)]
    variants += [Options(ranks=4, domains=grid), Options(ranks=1, threads=2)]
    runs = [run(SCENES / f"{scene}.toml", tmp_path / str(i), options) for i, options in enumerate(variants)]
    assert_all_equal(runs, samples={"fields_2d": 11, "fields_3d": 11, "cavity": 16}[scene])
    assert ("field of force" in runs[0].record["terms"]) == scene.startswith("fields")


def test_the_gas_solid_scene(tmp_path: Path) -> None:
    file = ROOT / "cases" / "gas_solid_small" / "case.toml"
    overrides = ("output.sample=50", "output.snapshot=0", "output.checkpoint=0")
    variants = [Options(ranks=ranks, steps=STEPS, overrides=overrides) for ranks in (0, 1, 2, 3, 4)]
    variants.append(Options(ranks=4, domains="2x2", steps=STEPS, overrides=overrides))
    variants.append(Options(ranks=1, threads=2, steps=STEPS, overrides=overrides))
    assert_all_equal([run(file, tmp_path / str(i), options) for i, options in enumerate(variants)], samples=21)


def test_a_restart_of_the_gas_solid_scene(tmp_path: Path) -> None:
    file = ROOT / "cases" / "gas_solid_small" / "case.toml"
    overrides = (f"output.checkpoint={STEPS // 2}",)
    through = run(file, tmp_path / "through", Options(ranks=2, steps=STEPS, overrides=overrides))
    assert_all_equal([through, restarted(file, tmp_path / "restarted", before=4, after=3)], samples=11)
