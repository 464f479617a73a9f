"""compare-bits names the first divergent step, particle, field and pair of a faulty solver.

Oracle: two faults of tests/mutation, of which it is known what they do.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import h5py
import pytest

from tests.mutation.__main__ import only_run, write_whole_tree
from tests.mutation.manifest import read_manifests
from tests.mutation.tree import BUILD, build_tree
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT

SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"


@pytest.fixture(scope="module")
def planted() -> Iterator[dict[str, str]]:
    """A build in which every fault of tests/mutation sleeps; by the names of two of them, what wakes them."""
    faults = read_manifests()
    with only_run():
        write_whole_tree(faults)
        build_tree(["mappm"], os.cpu_count() or 1)
        yield {fault.id: str(fault.number) for fault in faults}


def compared(ranks: str, fault: str) -> list[str]:
    """Lines of what is found with a fault awake in the parallel solver; the serial reference has none."""
    words = ["compare-bits", str(SCENE), "--ranks", ranks, "--steps", "40", "--every", "20", "--build", str(BUILD)]
    finished = subprocess.run([sys.executable, "-m", "verification", *words], cwd=ROOT, env=os.environ | {"MAPPM_MUTANT": fault},
                              capture_output=True, text=True)
    assert finished.returncode == 1, finished.stdout + finished.stderr
    print(finished.stdout)
    return finished.stdout.splitlines()


def ids_of_particles(folder: Path) -> list[int]:
    finished = run(SCENE, folder, Options(ranks=0, steps=1, overrides=("output.checkpoint=1",)))
    (checkpoint,) = (finished.folder / "checkpoints").iterdir()
    with h5py.File(checkpoint) as file:
        return [int(i) for i in file["fluid/id"]]


def test_a_dropped_ghost_is_named_as_the_missing_partner(planted: dict[str, str]) -> None:
    lines = compared("2", planted["some-ghosts-missing"])
    assert lines[0] == "first difference at step 20:"
    found = re.fullmatch(
        r"first divergent step 1: (\d+) particles, \d+ solids differ; first PP (\d+), fields (.*)", lines[3]
    )
    assert found, lines
    assert int(found[1]) >= 2
    assert {"vx", "vy"} & set(found[3].split(", "))
    pairs = [line for line in lines if ": pair with " in line]
    missing = [line for line in pairs if line.endswith(": 1 times | 0 times")]
    assert missing and missing == pairs[: len(missing)]  # they are named before the others
    for line in missing:
        name = re.fullmatch(r"serial reference \| P=2, build build: pair with PP (\d+): .*", line)
        assert name and int(name[1]) % 7 == 5, line
    for line in pairs[len(missing) :]:  # the ghost is missing from densities, and so in the pressure of pairs that are there
        assert ": 1 times" not in line and ": 0 times" not in line, line


def test_a_fault_of_the_integration_shows_equal_pairs_and_its_field(tmp_path: Path, planted: dict[str, str]) -> None:
    kicked = [i for i in ids_of_particles(tmp_path) if i % 97 == 5]
    lines = compared("1", planted["velocity-from-nowhere"])
    assert lines[0] == "first difference at step 20:"
    assert lines[3] == (
        f"first divergent step 12: {len(kicked)} particles, 0 solids differ; first PP {min(kicked)}, fields vy"
    )
    assert lines[4].startswith(f"all pairs of PP {min(kicked)} are equal: the difference arose after")
