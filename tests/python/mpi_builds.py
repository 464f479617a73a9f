"""Makes the builds that the equivalence matrices name: the same sources by another compiler, or for another instruction set.
The cases themselves compare them over all their steps, after this test.

Oracle: the programs of this build.
"""

import os
import subprocess
import tomllib
from pathlib import Path

from verification.equivalence import Equivalence, read_equivalence, run_matrix
from verification.solver import ROOT


def matrices() -> dict[Path, Equivalence]:
    found = {}
    for file in sorted((ROOT / "cases").glob("*/case.toml")):
        table = tomllib.loads(file.read_text())["case"]
        if "equivalence" in table:
            found[file] = read_equivalence(table["equivalence"], f"{file}: case.equivalence")
    return found


def test_other_builds_give_the_same_bits(tmp_path: Path) -> None:
    """Builds the two programs, no tests, of every preset that some matrix names, and runs each a little."""
    chosen = {
        file: [v for v in matrix.variants if v.options.build or v.label == "serial"] for file, matrix in matrices().items()
    }
    werror = "ON" if os.environ.get("CI") == "true" else "OFF"
    for preset in sorted({v.options.build.name for variants in chosen.values() for v in variants if v.options.build}):
        subprocess.run(["cmake", "--preset", preset, "-D", f"MAPPM_WERROR={werror}"], cwd=ROOT, check=True)
        build = ["cmake", "--build", "--preset", preset, "--parallel", str(os.cpu_count()), "--target"]
        subprocess.run([*build, "mappm", "mappm-reference"], cwd=ROOT, check=True)
    for file, variants in chosen.items():
        if len(variants) > 1:
            matrix = run_matrix(file, Equivalence(60, 20, tuple(variants)), tmp_path / file.parent.name)
            assert matrix.equal and not any(row.skipped for row in matrix.rows), "\n".join(matrix.lines)


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
