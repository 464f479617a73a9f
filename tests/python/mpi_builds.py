"""The builds that the equivalence matrices name: the same sources by another compiler, or for other instruction sets.
`check` makes them; where one is missing, what needs it is skipped. The cases themselves compare them over all their steps.

Oracle: the programs of this build; of where instructions lie, the disassembler.
"""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from verification.bits.equivalence import Equivalence, read_equivalence, run_matrix
from verification.codes.mappm import INSTRUCTION_SETS, Options, best_instruction_set, run
from verification.protocol.errors import SolverError
from verification.protocol.machine import ROOT

PORTABLE = ROOT / "build" / "portable"
SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"


def matrices() -> dict[Path, Equivalence]:
    found = {}
    for file in sorted((ROOT / "cases").glob("*/case.toml")):
        table = tomllib.loads(file.read_text())["case"]
        if "equivalence" in table:
            found[file] = read_equivalence(table["equivalence"], f"{file}: case.equivalence")
    return found


def need(build: Path) -> None:
    if not (build / "bin" / "mappm").exists():
        assert os.environ.get("CI") != "true", f"{build} has no program"
        pytest.skip(f"{build} is not made: ./check makes it")


@pytest.fixture(scope="module")
def portable() -> None:
    need(PORTABLE)


def test_check_makes_the_builds_that_the_matrices_name() -> None:
    made = re.findall(r"^(?:! .* \|\| )?build (\w+) mappm", (ROOT / "check").read_text(), re.MULTILINE)
    variants = [variant for matrix in matrices().values() for variant in matrix.variants]
    assert set(made) == {variant.options.build.name for variant in variants if variant.options.build}


@pytest.mark.parametrize("file", matrices(), ids=lambda file: file.parent.name)
def test_other_builds_give_the_same_bits(tmp_path: Path, file: Path) -> None:
    """Runs each a little."""
    variants = [v for v in matrices()[file].variants if v.options.build or v.label == "serial"]
    for variant in variants:
        if variant.options.build:
            need(variant.options.build)
    if len(variants) > 1:
        matrix = run_matrix(file, Equivalence(60, 20, tuple(variants)), tmp_path)
        skipped = [row for row in matrix.rows if row.skipped and not row.skipped.startswith("this processor has no")]
        assert matrix.equal and not skipped, "\n".join(matrix.lines)


@pytest.mark.usefixtures("portable")
def test_a_portable_build_takes_the_best_and_refuses_what_the_processor_lacks(tmp_path: Path) -> None:
    best = best_instruction_set(PORTABLE)
    for index, isa in enumerate(INSTRUCTION_SETS):
        options = Options(ranks=2, steps=1, build=PORTABLE, isa=isa)
        if index <= INSTRUCTION_SETS.index(best):
            assert run(SCENE, tmp_path / isa, options).record["instruction_set"] == isa
        else:
            with pytest.raises(SolverError, match=f"--isa = {isa}: this processor lacks it; .* chooses {best} here"):
                run(SCENE, tmp_path / isa, options)
    assert run(SCENE, tmp_path / "best", Options(steps=1, build=PORTABLE)).record["instruction_set"] == best


# What code for a set must not have, as the disassembler writes it: AVX at all; registers and masks of AVX-512.
FOREIGN = {"plain": r":\s+v|%[yz]mm", "avx2": r"%zmm|%[xy]mm(1[6-9]|[23]\d)|%k\d", "avx512": r"nothing"}


@pytest.mark.usefixtures("portable")
@pytest.mark.parametrize("isa", INSTRUCTION_SETS)
def test_code_for_one_instruction_set_cannot_be_taken_for_another(isa: str) -> None:
    """The linker keeps one of several copies of an inline function: no set may offer any, nor run code at start."""

    def said(*command: str) -> str:
        file = PORTABLE / "solver" / f"mappm_{isa}.o"
        return subprocess.run([*command, file], capture_output=True, text=True, check=True).stdout

    assert said("nm", "--extern-only", "--defined-only", "--format=just-symbols").split() == [f"main_{isa}"]
    assert "COMDAT" not in said("readelf", "--section-groups", "--wide")
    assert not re.search(r" \.(preinit_array|init_array|ctors)", said("readelf", "--sections", "--wide"))
    assert not re.search(FOREIGN[isa], said("objdump", "--disassemble", "--no-show-raw-insn"))


def test_the_matrices_hold_what_the_method_promises() -> None:
    by_case = {file.parent.name: {variant.label for variant in matrix.variants} for file, matrix in matrices().items()}
    ranks = {f"P={count}" for count in (1, 2, 3, 4, 7, 8)}
    builds = {"build reference", "build clang", *(f"build {PORTABLE.name} isa {isa}" for isa in INSTRUCTION_SETS)}
    for case in ("crossing_2d", "crossing_3d"):
        assert by_case[case] >= ranks | builds | {"serial", "threads 2"}
        assert any("restart" in label for label in by_case[case])
    assert "serial all-pairs" in by_case["crossing_2d"]
    assert by_case["crossing_2d"] >= {"domains 2x2", "domains 3x1"}
    assert by_case["crossing_3d"] >= {"domains 2x1x1", "domains 1x2x1", "domains 2x2x2"}
