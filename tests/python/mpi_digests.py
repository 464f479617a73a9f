"""What the matrices of equivalence do not say: that their scenes are worth comparing, and that other fields, walls,
restarts and single precision have the same bits too.

Oracle: the motion that the scenes are for; the serial reference, another program without MPI.
"""

from pathlib import Path

import numpy as np
import pytest

from verification.bits.compare import VariantRun, compare_runs, run_variant
from verification.codes.mappm import Options
from verification.protocol.machine import ROOT
from verification.protocol.run import Run
from verification.protocol.series import Table, read_table

SCENES = Path(__file__).parent / "scenes"
STEPS = 1000
GAS_SOLID_STEPS = 400


def solids_of(finished: Run) -> Table:
    return read_table(finished.folder / "solids.csv")


def travelled(solids: Table, axis: str, side: float) -> np.ndarray:
    """Distance each solid came along an axis, unwrapped from sample to sample (none moves half a box between two)."""
    ids = np.unique(solids["id"])
    paths = [np.unwrap(solids["position_" + axis][solids["id"] == solid], period=side) for solid in ids]
    return np.array([path[-1] - path[0] for path in paths])


def assert_all_equal(runs: list[VariantRun], samples: int) -> None:
    comparison = compare_runs(tuple(runs))
    assert comparison.equal, "\n".join(comparison.lines)
    assert len(runs[0].series) == samples
    for finished in runs:
        for axis in "xyz"[: len(finished.scene["box"]["size"])]:
            momentum = [int(total) for total in finished.series["momentum_" + axis]]
            impulse = [int(total) for total in finished.series["impulse_" + axis]]
            assert [total - momentum[0] for total in momentum] == impulse  # integers: equal, not close


@pytest.mark.parametrize("scene", ["crossing_2d", "crossing_3d"])
def test_solids_cross_borders_turn_and_meet(tmp_path: Path, scene: str) -> None:
    finished = run_variant(ROOT / "cases" / scene / "case.toml", tmp_path, Options(ranks=4, steps=STEPS))
    solids, box = solids_of(finished), finished.scene["box"]["size"]
    long, short = "xyz"[len(box) - 1], "x"
    # Every solid comes further along the slabs than one of eight is wide, some further than half of the shorter side.
    assert np.all(np.abs(travelled(solids, long, box[-1])) > box[-1] / 8)
    assert np.any(np.abs(travelled(solids, short, box[0])) > box[0] / 2)
    upright = "orientation_cos" if len(box) == 2 else "orientation_w"
    assert np.all(solids[upright][solids["step"] == STEPS] < 0.999)
    # Some collide: at some sample two surfaces overlap, as the spring of the contact law lets them. The contacts are
    # counted over borders in tests/mpi/engine.cpp.
    assert closest_gap(solids, box, finished.scene["body"][0]["radius"]) < 0.0


def closest_gap(solids: Table, box: list[float], radius: float) -> float:
    """Smallest distance of two surfaces over all samples, by the nearest image."""
    smallest = np.inf
    for step in np.unique(solids["step"]):
        at = solids["step"] == step
        places = np.column_stack([solids["position_" + axis][at] for axis in "xyz"[: len(box)]])
        apart = places[:, None, :] - places[None, :, :]
        apart -= np.array(box) * np.round(apart / np.array(box))
        distance = np.linalg.norm(apart, axis=-1) + np.diag(np.full(len(places), np.inf))
        smallest = min(smallest, float(distance.min()) - 2.0 * radius)
    return smallest


@pytest.mark.parametrize(
    ("scene", "options", "axis"),
    [
        ("crossing_2d", Options(ranks=3, steps=1), 1),
        ("crossing_2d", Options(ranks=3, domains="3x1", steps=1), 0),
        ("crossing_3d", Options(ranks=3, steps=1), 2),
    ],
)
def test_borders_that_follow_the_load_make_uneven_slabs(tmp_path: Path, scene: str, options: Options, axis: int) -> None:
    finished = run_variant(ROOT / "cases" / scene / "case.toml", tmp_path, options)
    borders = finished.record["borders"]
    assert [len(along) for along in borders] == [count + 1 for count in finished.record["domains"]]
    assert [along[-1] for along in borders] == pytest.approx(finished.scene["box"]["size"], rel=1e-12)
    widths = np.diff(borders[axis])
    assert len(widths) == 3
    assert widths.max() > 1.01 * widths.min()  # by more than rounding of an even division, 1e-15


@pytest.mark.parametrize(
    ("scene", "grid"), [("fields_2d", "2x2"), ("fields_3d", "1x2x2"), ("cavity", "2x2"), ("room", "2x1x2")]
)
def test_fields_disorder_and_walls_of_several_directions(tmp_path: Path, scene: str, grid: str) -> None:
    variants = [Options(ranks=ranks) for ranks in (0, 1, 2, 3, 4)]
    variants += [Options(ranks=4, domains=grid), Options(ranks=1, threads=2)]
    runs = [run_variant(SCENES / f"{scene}.toml", tmp_path / str(i), options) for i, options in enumerate(variants)]
    assert_all_equal(runs, samples={"cavity": 16, "room": 5}.get(scene, 11))
    assert ("field of force" in runs[0].record["terms"]) == scene.startswith("fields")


def test_a_restart_of_the_gas_solid_scene(tmp_path: Path) -> None:
    file = ROOT / "cases" / "gas_solid_small" / "case.toml"
    overrides = (f"output.checkpoint={GAS_SOLID_STEPS // 2}",)
    through = run_variant(file, tmp_path / "through", Options(ranks=2, steps=GAS_SOLID_STEPS, overrides=overrides))
    run_variant(file, tmp_path / "restarted", Options(ranks=4, steps=GAS_SOLID_STEPS // 2, overrides=overrides))
    (checkpoint,) = (tmp_path / "restarted" / "checkpoints").iterdir()
    options = Options(ranks=3, steps=GAS_SOLID_STEPS, overrides=overrides, resume=checkpoint)
    assert_all_equal([through, run_variant(file, tmp_path / "restarted", options)], samples=9)


@pytest.mark.parametrize("scene", ["crossing_2d", "crossing_3d"])
def test_single_precision_has_the_same_bits_everywhere(tmp_path: Path, scene: str) -> None:
    overrides = ("fluid.precision=single", "output.sample=20", "output.checkpoint=60")
    variants = [Options(ranks=ranks, steps=120, overrides=overrides) for ranks in (0, 1, 2, 4)]
    variants.append(Options(ranks=2, threads=2, steps=120, overrides=overrides))
    file = ROOT / "cases" / scene / "case.toml"
    runs = [run_variant(file, tmp_path / str(i), options) for i, options in enumerate(variants)]
    assert_all_equal(runs, samples=7)
    assert all("single precision of pairs" in finished.record["terms"] for finished in runs)
    run_variant(file, tmp_path / "restarted", Options(ranks=2, steps=60, overrides=overrides))
    (checkpoint,) = (tmp_path / "restarted" / "checkpoints").iterdir()
    resumed = run_variant(file, tmp_path / "restarted", Options(ranks=4, steps=120, overrides=overrides, resume=checkpoint))
    assert_all_equal([runs[0], resumed], samples=7)
    full = run_variant(file, tmp_path / "double", Options(ranks=1, steps=120, overrides=overrides[1:]))
    assert full.record["digest"] != runs[0].record["digest"]
