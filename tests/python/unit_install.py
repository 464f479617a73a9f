"""A program outside the project builds on the installed package, and gets the bits of the installed programs.

Oracle: the digest that the installed mappm-reference prints for the same scene.
"""

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from verification.codes.mappm import MPI_ENVIRONMENT, build_folder
from verification.protocol.machine import ROOT

PROJECT = ROOT / "tests" / "install"
SCENE = ROOT / "tests" / "python" / "scenes" / "random_discs.toml"  # in the plane, with solids in contact
STEPS = 40


def call(*words: object) -> str:
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                          env=os.environ | MPI_ENVIRONMENT)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("installed")
    call("cmake", "--install", build_folder(), "--prefix", folder)
    return folder


def configure(installed: Path, build: Path, *options: str) -> list[str]:
    """The command that configures PROJECT, with the compiler of the build that was installed."""
    cache = (build_folder() / "CMakeCache.txt").read_text()
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE)
    return ["cmake", "-G", "Ninja", "-S", str(PROJECT), "-B", str(build), f"-DCMAKE_PREFIX_PATH={installed}",
            f"-DCMAKE_CXX_COMPILER={compiler[1]}", *options]


@pytest.fixture(scope="module")
def reference_digest(installed: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    out = tmp_path_factory.mktemp("reference") / "out"
    said = call(installed / "bin" / "mappm-reference", "run", SCENE, "--steps", STEPS, "--out", out)
    return re.search(rf"^digest (\w{{16}}) step {STEPS} ", said, re.MULTILINE)[1]


def test_a_program_on_the_package_gets_the_bits_of_the_reference(installed: Path, reference_digest: str,
                                                                 tmp_path: Path) -> None:
    # Flags of its own that would change bits of inline code, and that those of the targets have to overrule.
    call(*configure(installed, tmp_path, "-DPARALLEL=ON", "-DCMAKE_CXX_FLAGS=-O1 -ffp-contract=fast"))
    call("cmake", "--build", tmp_path)
    for command in json.loads((tmp_path / "compile_commands.json").read_text()):
        assert re.findall(r"-ffp-contract=\w+", command["command"])[-1] == "-ffp-contract=off"
        assert str(ROOT / "solver") not in command["command"]
    assert call(tmp_path / "embedded", SCENE, STEPS).strip() == reference_digest
    assert call(tmp_path / "embedded-parallel", SCENE, STEPS).strip() == reference_digest
    assert call("mpirun", "-np", 2, tmp_path / "embedded-parallel", SCENE, STEPS).strip() == reference_digest


def test_another_major_version_is_refused(installed: Path, tmp_path: Path) -> None:
    done = subprocess.run(configure(installed, tmp_path, "-DMAPPM_VERSION=2.0"), capture_output=True, text=True)
    assert done.returncode != 0
    assert 'requested version "2.0"' in " ".join(done.stderr.split())
    assert "MaPPMConfig.cmake, version: 1." in done.stderr


def test_the_package_needs_mpi_for_its_parallel_part_alone(installed: Path, tmp_path: Path) -> None:
    said = call(*configure(installed, tmp_path))
    assert "Found MPI" not in said
    assert "MPI::" not in "".join(path.read_text() for path in installed.rglob("MaPPMTargets*.cmake"))


def test_what_is_installed_names_no_folder_of_the_sources(installed: Path) -> None:
    texts = {path: path.read_text() for ending in ("*.hpp", "*.cmake") for path in installed.rglob(ending)}
    assert len(texts) > 50
    for path, text in texts.items():
        assert str(ROOT) not in text and str(build_folder()) not in text, path


def test_installed_headers_include_only_each_other_and_public_dependencies(installed: Path) -> None:
    headers = installed / "include" / "mappm"
    layers = {path.name for path in headers.iterdir()}
    assert {"base", "physics", "particles", "scene", "serial", "parallel", "output", "library"} == layers
    foreign = set()
    for path in headers.rglob("*.hpp"):
        for line in re.findall(r"^#include (.+)$", path.read_text(), re.MULTILINE):
            if line.startswith('"'):
                assert (headers / line.strip('"')).exists(), f"{path} includes {line}"
            elif "/" in line and not line.startswith("<experimental/") or line.endswith(".h>"):
                foreign.add(line)
    assert foreign <= {"<fmt/format.h>", "<immintrin.h>", "<omp.h>"}


def test_the_programs_are_installed(installed: Path) -> None:
    for name in ("mappm", "mappm-reference"):
        assert call(installed / "bin" / name, "--version").startswith(f"{name} 1.")
