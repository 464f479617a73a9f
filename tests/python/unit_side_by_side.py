"""Pictures and chapters that set two codes side by side. Oracles: fields made here that are equal, or apart by a known amount."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from verification.protocol.points import write_points
from verification.protocol.run import Run
from verification.report.chapters import families_of
from verification.report.reference_codes import reference_codes
from verification.report.side_by_side import NODES, apart, caption, compare_fields, speeds
from verification.suite.references import Reference

SIDE, RADIUS = 2.0, 0.4
SCENE = {"box": {"size": [SIDE, SIDE]}, "fluid": {"spacing": 0.05, "rcut": 0.2},
         "body": [{"shape": "disc", "radius": RADIUS, "position": [0.1, 1.0], "motion": "fixed"}]}


def field(points: np.ndarray) -> np.ndarray:
    """Zero on the surface of the disc, smooth and periodic beyond."""
    offset = points[:, :2] - [0.1, 1.0]
    offset -= SIDE * np.round(offset / SIDE)
    speed = 1 + 0.2 * np.cos(np.pi * points[:, 1])
    speed *= 1 - np.exp(-((np.linalg.norm(offset, axis=1) - RADIUS) / 0.5))
    return np.column_stack([speed, np.zeros_like(speed)])


def scattered(seed: int, count: int) -> np.ndarray:
    points = np.random.default_rng(seed).uniform(0, SIDE, (count, 2))
    offset = points - [0.1, 1.0]
    offset -= SIDE * np.round(offset / SIDE)
    return points[np.linalg.norm(offset, axis=1) > RADIUS]


def both(folder: Path, factor: float) -> tuple[SimpleNamespace, Run]:
    ours, theirs = scattered(1, 6000), scattered(2, 9000)
    write_points(folder, 0, 0.0, theirs, factor * field(theirs))
    run = SimpleNamespace(scene=SCENE, fluid=lambda: {"points": ours, "velocity": field(ours)})
    return run, Run(folder)


@pytest.mark.parametrize("factor", [1.0, 1.1])
def test_fields_are_brought_to_one_grid(tmp_path: Path, factor: float) -> None:
    _, ours, theirs = speeds(*both(tmp_path, factor))
    assert np.isnan(ours[100, 10]) and np.isnan(theirs[100, 199])  # inside the disc, and inside its periodic image
    share = np.isnan(ours).mean()
    assert share == pytest.approx(np.pi * RADIUS**2 / SIDE**2, rel=0.02)
    assert np.nanmean(theirs / np.where(ours > 0.1, ours, np.nan)) == pytest.approx(factor, abs=0.01)


def test_a_body_that_moves_is_seen_at_rest(tmp_path: Path) -> None:
    fixed, other = both(tmp_path, 1.0)
    way, own = np.array([0.7, -1.3]), np.array([3.0, -2.0])
    body = SCENE["body"][0] | {"motion": "moving", "velocity": list(own)}
    at_rest = fixed.fluid()
    moved = {"points": np.mod(at_rest["points"] + way, SIDE), "velocity": at_rest["velocity"] + own}
    moving = SimpleNamespace(scene=SCENE | {"body": [body]}, fluid=lambda: moved,
                             solids=lambda: {"points": np.array([[*np.mod([0.1 + way[0], 1.0 + way[1]], SIDE), 0.0]])})
    assert np.allclose(speeds(moving, other)[1], speeds(fixed, other)[1], atol=1e-6, equal_nan=True)


def test_the_picture_is_written(tmp_path: Path) -> None:
    compare_fields(*both(tmp_path, 1.1), "Other", "title", tmp_path / "beside.png")
    assert (tmp_path / "beside.png").stat().st_size > 10_000


def result(name: str, holds: bool, code: str = "", rows: int = 1) -> SimpleNamespace:
    live = Reference(code.capitalize()) if code else None
    case = SimpleNamespace(name=name, family=name.partition(".")[0], live=SimpleNamespace(code=code) if code else None)
    outcomes = tuple(SimpleNamespace(observable=SimpleNamespace(live="drag" if code else "")) for _ in range(rows))
    return SimpleNamespace(case=case, holds=holds, live=live, outcomes=outcomes)


def test_families_that_fail_come_first_and_rows_are_gathered_by_code() -> None:
    results = [result("a", True), result("b.2", True, "openfoam"), result("b.1", False, "openfoam"),
               result("c", True, "liggghts"), result("peer", True, "liggghts", rows=0)]
    families = families_of(results)
    assert [family.name for family in families] == ["b", "a", "c", "peer"]
    assert [one.case.name for one in families[0].results] == ["b.1", "b.2"]
    openfoam, liggghts = reference_codes(results)
    assert (openfoam.code, openfoam.id, len(openfoam.rows)) == ("Openfoam", "openfoam", 2)
    assert [one.case.name for one in liggghts.shown] == ["peer"]


def test_the_difference_is_told_within_a_cutoff_of_the_surface_and_beyond() -> None:
    x, y = np.meshgrid(*2 * [(np.arange(NODES) + 0.5) / NODES * SIDE])
    offset = np.stack([x - 0.1, y - 1.0])
    distance = np.linalg.norm(offset - SIDE * np.round(offset / SIDE), axis=0) - RADIUS
    difference = np.where(distance < 0, np.nan, np.where(distance < 0.2, -0.3, 0.02))
    found = apart(SCENE, difference)
    assert found.layer == pytest.approx(0.3) and found.beyond == pytest.approx(0.02)
    near = np.pi * ((RADIUS + 0.2) ** 2 - RADIUS**2) / (SIDE**2 - np.pi * RADIUS**2)  # share of the fluid
    assert found.mean == pytest.approx(0.02 - 0.32 * near, abs=2e-3)
    assert found.whole == pytest.approx(np.sqrt(near * 0.3**2 + (1 - near) * 0.02**2), abs=2e-3)
    assert "an rms of 30 %, beyond it 2 % of the mean speed" in caption(found, "Other")


def test_the_map_is_explained_in_the_picture(tmp_path: Path, drawn: list) -> None:
    compare_fields(*both(tmp_path, 1.1), "Other", "title", tmp_path / "beside.png")
    assert "one cutoff from the surface" in drawn[0]._supxlabel.get_text()
    panels = [axes for axes in drawn[0].axes if axes.get_label() != "<colorbar>"]
    assert [len(panel.patches) for panel in panels] == [0, 0, 9]  # the layer and its images
    assert all(panel.get_xlabel() == "x" and len(panel.get_xticks()) > 1 for panel in panels)
