"""Parameters and formulas of cases. Oracles: numbers worked out by hand, the plain scenes as they stand, and the solver itself."""

import copy
import math
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from support import ANY_CODE

from verification.codes.mappm import program
from verification.protocol.errors import CaseError
from verification.protocol.machine import ROOT
from verification.protocol.scene import with_overrides
from verification.protocol.toml_text import scene_text, value_text
from verification.suite.case import Case
from verification.suite.manifest import all_cases, find_case, read_cases
from verification.suite.parameters import derived, overrides_of, scene_of
from verification.suite.references import reference_request
from verification.suite.runner import Job

MANIFEST = """
units = "dimensionless"
[case]
purpose = "p"
tier = "quick"
cost = 10
[case.parameters]
phi = 0.25
R_over_dx = 4
method = "shifted"
along = [3, 4]
[case.formulas]
side = "2 * sqrt(1 / phi)"
"box.size" = "[side, side]"
"fluid.spacing" = "1 / R_over_dx"
"fluid.method" = "method"
"force.fluid" = "[along[0] / side**2, along[1] / side**2]"
[case.live]
code = "openfoam"
problem = "drag"
quick = []
full = []
[[case.observable]]
name = "drag"
symbol = "F"
live = "drag"
goal = 0.02
since = 2026-11-22
[[case.point]]
name = "dense"
set = ["phi=1"]
[[case.level]]
set = ["R_over_dx=3"]
[[case.level]]
set = ["fluid.spacing=0.2"]
[box]
size = [4.0, 4.0]
[fluid]
spacing = 0.25
method = "shifted"
sound_speed_factor = 10.0
[[body]]
radius = 1.0
[force]
fluid = [0.1875, 0.25]
"""


def written(folder: Path, old: str = "", new: str = "") -> Path:
    file = folder / "family" / "case.toml"
    file.parent.mkdir(exist_ok=True)
    assert old in MANIFEST
    file.write_text(MANIFEST.replace(old, new, 1) if old else MANIFEST)
    return file


def plain(scene: dict) -> dict:
    return {key: value for key, value in scene.items() if key != "case"}


def sets_of(case: Case) -> list[tuple[str, ...]]:
    """Those of the case or point, its levels, variations and what is measured beside."""
    base = case.quick_finest().overrides
    changed = [chosen for vary in case.vary for chosen in vary.sets] + [beside.overrides for beside in case.beside]
    return [case.base, *(level.overrides for level in case.levels), *(base + chosen for chosen in changed)]


def test_a_parameter_reaches_all_that_follows_from_it(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    assert dense.scene["box"]["size"] == [2.0, 2.0] and dense.scene["force"]["fluid"] == [0.75, 1.0]
    fine = scene_of(dense, (*dense.base, "R_over_dx=3", "along=[8, 0]", "method=classic"))
    assert fine["fluid"] == {"spacing": 1 / 3, "method": "classic", "sound_speed_factor": 10.0}
    assert fine["force"]["fluid"] == [2.0, 0.0]
    assert dense.plain["box"]["size"] == [4.0, 4.0]  # left as it was


def test_a_key_of_the_scene_wins_over_a_formula(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    found = scene_of(dense, ("box.size=[8, 8]", "phi=1", "body=[{radius=2.0}]"))
    assert (found["box"]["size"], found["force"]["fluid"], found["body"]) == ([8, 8], [0.75, 1.0], [{"radius": 2.0}])


def test_overrides_are_what_differs_to_the_last_bit(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    assert overrides_of(dense, ()) == ()
    assert overrides_of(dense, ("fluid.spacing=0.25", "phi=0.250")) == ()
    assert overrides_of(dense, ("R_over_dx=3", "fluid.method=classic")) == (
        "fluid.spacing=0.3333333333333333", 'fluid.method="classic"')
    assert overrides_of(dense, ("body.0.motion=fixed",)) == ('body.0.motion="fixed"',)
    assert overrides_of(dense, ('body=[{shape="disc"}]', "box={size=[1, 2]}")) == ("box.size=[1, 2]", 'body.0={shape = "disc"}')
    assert overrides_of(dense, ("fluid.sound_speed=1e-5",)) == ("fluid.sound_speed=1e-05",)  # the solver drops the factor


def test_one_of_two_alternatives_is_left(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    assert "sound_speed_factor" not in scene_of(dense, ("fluid.sound_speed=1e-5",))["fluid"]


def test_a_case_without_parameters_keeps_its_overrides() -> None:
    case = find_case("two_spheres_impact")
    assert not case.parameters
    assert overrides_of(case, ("run.step=8e-8", "run.step=4e-8")) == ("run.step=8e-8", "run.step=4e-8")


def test_runs_and_references_get_the_derived_scene(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    job = Job(dense, (*dense.base, "R_over_dx=8"), ANY_CODE)
    assert job.weight == pytest.approx(80.0)  # its cost is 10; half the spacing: four times the PPs, twice the steps
    assert job.label == "R_over_dx=8"
    plain_scene = dense.plain | {"box": {"size": [2.0, 2.0]}, "force": {"fluid": [0.75, 1.0]}}
    assert plain(job.request.scene) == plain(plain_scene | {"fluid": dense.plain["fluid"] | {"spacing": 0.125}})
    reference = reference_request(dense, "quick", {}, ANY_CODE)
    assert plain(reference.scene) == plain(plain_scene | {"fluid": dense.plain["fluid"] | {"spacing": 0.2}})


def test_runs_of_one_derived_scene_are_one(tmp_path: Path) -> None:
    """However it was asked for."""
    (dense,) = read_cases(written(tmp_path))
    keys = [Job(dense, sets, ANY_CODE).request.key for sets in
            (("phi=1", "R_over_dx=8"), ("phi=1.0", "fluid.spacing=0.125"), ("box.size=[2, 2]", "force.fluid=[0.75, 1]", "R_over_dx=8"))]
    assert keys == keys[:1] * 3
    assert Job(dense, ("phi=1", "R_over_dx=9"), ANY_CODE).request.key != keys[0]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"1 / R_over_dx"', '"1 / r_over_dx"', "formulas.fluid.spacing = '1 / r_over_dx': r_over_dx: no such name; known here are"),
        ('"1 / R_over_dx"', '"1 / side_"', "side_: no such name"),
        ('"1 / R_over_dx"', '"1 / / R_over_dx"', "no expression: invalid syntax; mend it"),
        ('"1 / R_over_dx"', '"open(R_over_dx)"', "open: no such function; known are sqrt"),
        ('"1 / R_over_dx"', '"R_over_dx.real"', "mend the expression"),
        ('"1 / R_over_dx"', '"1 / (R_over_dx - 4)"', "division by zero; mend the expression"),
        ('"1 / R_over_dx"', '"R_over_dx < 3"', "gives False; write what gives a number"),
        ('"1 / R_over_dx"', "0.25", "formulas.fluid.spacing = 0.25: wrong type; write the expression as a text"),
        ('"fluid.spacing" = ', '"fluid.spacings" = ', "formulas.fluid.spacings = '1 / R_over_dx': the scene has no such key"),
        ('"fluid.spacing" = ', '"body.1.radius" = ', "the scene has no such key"),
        ("phi = 0.25", "phi = 0.25\nRe = 1", "parameters.Re = 1: no formula uses it; use it or remove it"),
        ('"fluid.method" = ', "help = ", "formulas.help = 'method': no formula uses it"),
        ("side = ", "phi = ", "a parameter has that name; rename the helper"),
        ("phi = 0.25", "phi = 0.25\nbox = 1", "parameters.box = 1: the scene has a key of that name"),
        ("phi = 0.25", "phi = 0.25\npi = 3", "parameters.pi = 3: no name for a parameter"),
        ("phi = 0.25", "phi = true", "parameters.phi = True: wrong type"),
        ("R_over_dx=3", "r_over_dx=3", "level[0]: r_over_dx=3: no such parameter; known are phi, R_over_dx"),
        ("R_over_dx=3", "R_over_dx=three", "level[0]: R_over_dx=three: wrong type; write a number, as 4 is"),
        ("phi=1", "psi=1", "case: psi=1: no such parameter; known are"),
        ("[case.parameters]", "[case.parameter]", "case.parameter: unknown; known are"),
    ],
)
def test_what_is_wrong_is_named_with_its_fix(tmp_path: Path, old: str, new: str, message: str) -> None:
    file = written(tmp_path, old, new)
    with pytest.raises(CaseError) as caught:
        read_cases(file)
    assert str(caught.value).startswith(f"{file}: case") and str(caught.value).count(str(file)) == 1
    assert message in str(caught.value)


def test_a_key_without_a_place_is_refused(tmp_path: Path) -> None:
    (dense,) = read_cases(written(tmp_path))
    with pytest.raises(CaseError, match="body.3.radius=1: no such key"):
        scene_of(dense, ("body.3.radius=1",))


CASES = all_cases()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_plain_scene_is_the_one_derived_at_the_defaults(case: Case) -> None:
    assert plain(derived(case.plain, case.parameters, case.formulas, ())) == plain(case.plain), (
        f"{case.file}: write {' '.join(overrides_of(case, ()))}")


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_overrides_give_every_derived_scene(case: Case) -> None:
    for sets in sets_of(case):
        assert with_overrides(copy.deepcopy(case.plain), overrides_of(case, sets)) == scene_of(case, sets)


def test_a_force_that_had_drifted_follows_from_the_drag() -> None:
    """K nu U / L^2, by hand: L^2 = pi / phi, nu = 20."""
    dense, bare = find_case("cylinder_stokes.phi_0.2"), find_case("cylinder_stokes.phi_0.2").plain
    assert dense.scene["force"]["fluid"][0] == pytest.approx(51.526949 * 20 * 0.2 / math.pi, rel=1e-15)
    assert dense.scene["force"] == bare["force"]


def test_a_scene_is_written_as_it_is_read() -> None:
    for case in CASES:
        assert tomllib.loads(scene_text(case.scene)) == plain(case.scene)
    assert value_text({"a": [True, 1e-7, 'say "x"']}) == '{a = [true, 1e-07, "say \\"x\\""]}'
    with pytest.raises(ValueError, match="nan is no number of a scene"):
        value_text(math.nan)


def test_the_solver_runs_the_scene_that_is_printed(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "verification", "scene", "cylinder_stokes.phi_0.4", "--set", "R_over_dx=4"]
    printed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, env=dict(os.environ)).stdout
    scene = tomllib.loads(printed)
    assert "case" not in scene and scene["fluid"]["spacing"] == 0.25
    file = tmp_path / "scene.toml"
    file.write_text(printed)
    subprocess.run([program("mappm"), "run", file, "--out", tmp_path / "out", "--steps", "1"], check=True, capture_output=True)
