"""The same bits in every way to run a scene: engine, ranks, grids of domains, threads, restart, compiler, instruction set.

Oracle: the first variant of each matrix, the serial reference, another program without MPI. The builds that a matrix
names are made here by their presets, from the same sources.
"""

import os
import subprocess
import tomllib
from pathlib import Path

import pytest

from verification.equivalence import Equivalence, read_equivalence, run_matrix
from verification.solver import ROOT


def matrices() -> dict[Path, Equivalence]:
    found = {}
    for file in sorted((ROOT / "cases").glob("*/case.toml")):
        table = tomllib.loads(file.read_text())["case"]
        if "equivalence" in table:
            found[file] = read_equivalence(table["equivalence"], f"{file}: case.equivalence")
    return found


@pytest.fixture(scope="module", autouse=True)
def _builds() -> None:
    """The two programs, no tests, of every preset that some matrix names."""
    named = {v.options.build.name for matrix in matrices().values() for v in matrix.variants if v.options.build}
    werror = "ON" if os.environ.get("CI") == "true" else "OFF"
    for preset in sorted(named):
        subprocess.run(["cmake", "--preset", preset, "-D", f"MAPPM_WERROR={werror}"], cwd=ROOT, check=True)
        build = ["cmake", "--build", "--preset", preset, "--parallel", str(os.cpu_count()), "--target"]
        subprocess.run([*build, "mappm", "mappm-reference"], cwd=ROOT, check=True)


@pytest.mark.parametrize("file", matrices(), ids=lambda file: file.parent.name)
def test_the_matrix_of_a_case_is_equal(tmp_path: Path, file: Path) -> None:
    matrix = run_matrix(file, matrices()[file], tmp_path)
    assert matrix.equal, "\n".join(matrix.lines)


def test_the_matrices_hold_what_the_method_promises() -> None:
    by_case = {file.parent.name: {variant.label for variant in matrix.variants} for file, matrix in matrices().items()}
    ranks = {f"P={count}" for count in (1, 2, 3, 4, 7, 8)}
    builds = {"build reference", "build clang", "build avx2"}
    for case in ("crossing_2d", "crossing_3d"):
        assert by_case[case] >= ranks | builds | {"serial", "threads 2"}
        assert any("restart" in label for label in by_case[case])
    assert "serial all-pairs" in by_case["crossing_2d"]
    assert by_case["crossing_2d"] >= {"domains 2x2", "domains 3x1"}
    assert by_case["crossing_3d"] >= {"domains 2x1x1", "domains 1x2x1", "domains 2x2x2"}
