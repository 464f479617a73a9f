"""The same bits from another compiler, another level of optimisation and another instruction set.

Oracle: the programs of this build. The others are built here by their presets, from the same sources.
"""

import os
import subprocess
from pathlib import Path

import pytest

from verification.compare import compare_runs
from verification.solver import ROOT, Options, run

SCENES = Path(__file__).parent / "scenes"


@pytest.mark.parametrize("preset", ["reference", "clang"])
def test_other_builds_give_the_same_bits(tmp_path: Path, preset: str) -> None:
    werror = "ON" if os.environ.get("CI") == "true" else "OFF"
    subprocess.run(["cmake", "--preset", preset, "-D", f"MAPPM_WERROR={werror}"], cwd=ROOT, check=True)
    build = ["cmake", "--build", "--preset", preset, "--parallel", str(os.cpu_count()), "--target"]
    subprocess.run([*build, "mappm", "mappm-reference"], cwd=ROOT, check=True)
    other = ROOT / "build" / preset
    for scene in ("crossing_2d", "crossing_3d"):
        variants = [Options(ranks=2), Options(ranks=2, build=other)]
        if scene == "crossing_2d":
            variants.append(Options(ranks=0, build=other))
        runs = [run(SCENES / f"{scene}.toml", tmp_path / f"{scene}{i}", options) for i, options in enumerate(variants)]
        comparison = compare_runs(tuple(runs))
        assert comparison.equal, "\n".join(comparison.lines)
