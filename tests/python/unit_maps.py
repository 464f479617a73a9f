"""Maps: classes of runs, points between neighbours, and what is measured of a last state.

Oracles: states made by hand, of which the class is known, and grids whose border is seen by eye.
"""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from verification.measures.health import flow, inside, nearest
from verification.protocol.errors import CaseError
from verification.report.map_chart import draw_map
from verification.store.laboratory import Laboratory
from verification.studies.classes import (
    BLOWN_UP,
    CLUMPED,
    DRIFTING,
    JAMMED,
    LEAKED,
    NO_VALUE,
    REFUSED,
    RIGHT,
    WRONG,
    class_of,
    class_of_failure,
)
from verification.studies.grid import between
from verification.studies.study import find_study, read_study, results_of, run_study

FLUID = {"nearest": 0.9, "inside": 0.0, "flow": 1.0}
MAP = """
[study]
purpose = "to see"
chart = "map"
refine = 1

[[study.block]]
factors = { "run.step_factor" = [0.5, 1.0, 2.0], N = [8, 12] }
"""


@pytest.fixture
def study_file(shear_wave: Path) -> Path:
    file = shear_wave / "study_where.toml"
    file.write_text(MAP)
    return file


@pytest.mark.parametrize("error, objection, health, kind", [
    (0.01, "", {}, RIGHT),
    (-0.019, "", {}, RIGHT),
    (0.01, "still faster at the end", {}, DRIFTING),
    (-0.03, "", {}, DRIFTING),
    (0.06, "", {}, WRONG),
    (-0.06, "still faster at the end", {}, WRONG),
    (float("nan"), "fewer than five snapshots", {}, NO_VALUE),
    (0.01, "", {"nearest": 0.3}, CLUMPED),
    (0.5, "", {"flow": 0.05}, JAMMED),
    (0.01, "", {"inside": 0.001, "nearest": 0.3}, LEAKED),
])
def test_the_worst_counts(error: float, objection: str, health: dict[str, float], kind: str) -> None:
    assert class_of(error, objection, FLUID | health) == kind


@pytest.mark.parametrize("words, kind", [
    ("mappm: step 82: particle 754: moves more than rcut/4 in one step (velocity 0.5 c before it); the step is too long", BLOWN_UP),
    ("mappm: step 3: particle 4: density 0.1 times rest, outside 0.25 to 4; the fluid tears", BLOWN_UP),
    ("out/series.csv: lowest_density_ratio: line 2: 'nan': must be a finite number", BLOWN_UP),
    ("mappm: scene.toml: run.step_factor = 2: the step 0.0125 is longer than 0.0094, the last that sound allows", REFUSED),
])
def test_last_words_tell_what_was_begun(words: str, kind: str) -> None:
    assert class_of_failure(words) == kind


def test_points_are_added_where_classes_differ() -> None:
    keys = ("a", "b")
    kinds = {("a=1", "b=1"): RIGHT, ("a=4", "b=1"): WRONG, ("a=1", "b=4"): RIGHT, ("a=4", "b=4"): RIGHT}
    assert between(keys, kinds) == [("a=2.0", "b=1.0"), ("a=4.0", "b=2.0")]


def test_nothing_is_added_within_a_class_or_between_close_neighbours() -> None:
    assert between(("a", "b"), {("a=1", "b=1"): RIGHT, ("a=4", "b=1"): RIGHT}) == []
    assert between(("a", "b"), {("a=1", "b=1"): RIGHT, ("a=1.05", "b=1"): WRONG}) == []


def state(points: np.ndarray, side: float, **more) -> SimpleNamespace:
    """A run of the plane as measures see it, spacing 1."""
    scene = {"box": {"size": [side, side]}, "fluid": {"spacing": 1.0} | more.get("fluid", {})}
    padded = np.column_stack([points, np.zeros(len(points))])
    return SimpleNamespace(scene=scene, fluid=lambda: {"points": padded}, snapshots=lambda kind="fluid": more.get("balls") and [1],
                           solids=lambda: more["balls"], series=more.get("series"))


def lattice(side: int) -> np.ndarray:
    return np.array([(i + 0.5, j + 0.5) for i in range(side) for j in range(side)], float)


def test_neighbours_of_a_lattice_are_a_spacing_away() -> None:
    assert nearest(state(lattice(40), 40.0)) == pytest.approx(1.0)


def test_neighbours_are_sought_across_the_border() -> None:
    points = np.array([[0.05, 5.0], [9.95, 5.0], [5.0, 0.1], [5.0, 9.8]])
    assert nearest(state(points, 10.0)) == pytest.approx(0.1, rel=0.01)


def test_particles_at_one_place_are_close() -> None:
    assert nearest(state(np.vstack([lattice(20), lattice(20)]), 20.0)) == 0.0


def test_pairs_are_close() -> None:
    points = lattice(40)
    rng = np.random.default_rng(1)
    pairs = np.vstack([points, points[:20] + rng.normal(0, 0.02, (20, 2))])
    assert nearest(state(pairs, 40.0)) < 0.1


def test_nearest_is_that_of_all_pairs() -> None:
    rng = np.random.default_rng(2)
    points = rng.uniform(0, 30.0, (1500, 2))
    gap = np.abs(points[:, None] - points[None])
    gap = np.minimum(gap, 30.0 - gap)
    distance = np.sqrt((gap**2).sum(axis=-1)) + 1e9 * np.eye(len(points))
    assert nearest(state(points, 30.0)) == pytest.approx(np.quantile(np.minimum(distance.min(axis=1), 2.0), 0.001))


def test_what_lies_deep_in_a_ball_has_leaked() -> None:
    balls = {"points": np.array([[0.0, 0.0, 0.0]]), "radius": np.array([3.0])}
    points = np.array([[2.6, 0.0], [2.4, 0.0], [38.0, 39.0], [20.0, 20.0]])  # 0.4 and 0.6 deep, 0.76 deep across the border, far
    assert inside(state(points, 40.0, balls=balls)) == pytest.approx(0.5)


def test_flow_is_in_units_of_the_declared_velocity() -> None:
    series = {"fluid_velocity_x": np.array([0.0, 3.0]), "fluid_velocity_y": np.array([0.0, 4.0])}
    assert flow(state(lattice(4), 4.0, series=series, fluid={"reference_velocity": 2.0})) == pytest.approx(2.5)
    assert flow(state(lattice(4), 4.0, series=series)) == 1.0


def test_a_map_runs_its_points_and_those_between(study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laboratory, study = Laboratory(tmp_path / "lab"), read_study(study_file)
    run_study(laboratory, study, 2, lambda text: None)
    results = results_of(laboratory, study)
    kinds = {result.setting: result.kind for result in results}
    assert kinds["run.step_factor=2.0", "N=8"] == REFUSED  # beyond the limit of sound
    assert len(results) > 6 and all(result.health["nearest"] > 0.5 for result in results if result.outcome)
    said: list[str] = []
    run_study(laboratory, study, 2, said.append)
    assert not said  # what is shown is all that it runs
    monkeypatch.setattr("verification.studies.study._health_id", lambda: "of other measures")
    run_study(laboratory, study, 2, said.append)
    assert not said and results_of(laboratory, study) == results  # measured again, of the states that were kept
    monkeypatch.setattr("verification.suite.refusals.commit", lambda: "another")
    assert results_of(laboratory, study) == results  # what the solver refuses, it refuses as long as its numerics are the same
    drawn = draw_map(study, results, tmp_path / "where.svg")
    assert sum(count for _, count, _ in drawn.counts) == len(results)
    assert len((tmp_path / "where.csv").read_text().splitlines()) == len(results) + 1


@pytest.mark.parametrize("wrong, named", [
    (MAP.replace(", N = [8, 12]", ""), "two factors"),
    (MAP.replace("[0.5, 1.0, 2.0]", "[0.5, 0]"), "above 0"),
    (MAP.replace("N = [8, 12]", '"fluid.kernel" = ["lucy"]'), "above 0"),
    (MAP.replace("refine = 1", "refine = -1"), "study.refine"),
    (MAP.replace('chart = "map"\n', ""), "study.refine"),
])
def test_wrong_maps_are_refused(study_file: Path, wrong: str, named: str) -> None:
    study_file.write_text(wrong)
    with pytest.raises(CaseError, match=named):
        read_study(study_file)


def test_the_maps_of_the_tree_can_be_read() -> None:
    assert find_study("cylinder_stokes.step_range").refine == 2
