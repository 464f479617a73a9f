"""compare-bits names the first divergent step, particle, field and pair of a faulty solver.

Oracle: the faults, which are planted here in a copy of the sources, so that what they do is known.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import h5py

from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT

SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"
COPY = ROOT / "build" / "planted"
BUILD = COPY / "build" / "fast"
SOURCES = ("CMakeLists.txt", "CMakePresets.json", "cmake", "solver", "tests", "bench")

# From the step from 17 to 18 on, ghosts whose id leaves 5 on division by 7 are missing across the lower face of each domain.
DROPPED = (
    "solver/parallel/halo.cpp",
    (
        "  for (std::size_t partner = 0; partner < partners_.size(); ++partner) {\n    Buffer& buffer = out_[partner];\n    std::uint64_t count",
        "  if (planted_step >= 17)\n"
        "    std::erase_if(selected_[1], [&](std::uint32_t i) {\n"
        "      return fluid.id[i] % 7 == 5 && !images_[1].region.contains(fluid.position(i));\n"
        "    });\n"
        "  for (std::size_t partner = 0; partner < partners_.size(); ++partner) {\n    Buffer& buffer = out_[partner];\n    std::uint64_t count",
    ),
    ("namespace mappm {\n", "namespace mappm {\nstatic std::uint64_t planted_step = 0;\n"),
    ("  pack_fluid(state.fluid, residents);\n", "  planted_step = state.step;\n  pack_fluid(state.fluid, residents);\n"),
)
# In the step from 11 to 12 some PPs gain one quantum of velocity along y that nobody gave them.
KICKED = (
    "solver/parallel/engine.cpp",
    (
        "  residents_->schedule().owned_moved(all.farthest());\n",
        "  residents_->schedule().owned_moved(all.farthest());\n"
        "  for (std::size_t k = 0; k < state_.fluid.size(); ++k)\n"
        "    if (state_.step == 11 && state_.fluid.id[k] % 97 == 5) state_.fluid.v(1)[k] += velocity_quantum;\n",
    ),
)


def copy_sources(changed: dict[str, str]) -> None:
    """Brings the copy up to date with `changed` texts; a source that stays as it is keeps its time and is not rebuilt."""
    listed = subprocess.run(["git", "ls-files", *SOURCES], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in listed.splitlines():
        content = changed[name].encode() if name in changed else (ROOT / name).read_bytes()
        path = COPY / name
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)


def plant(file: str, *replacements: tuple[str, str]) -> None:
    """Builds the parallel solver with one source changed."""
    text = (ROOT / file).read_text()
    for sound, faulty in replacements:
        assert text.count(sound) == 1, f"{file} has changed: {sound!r} stands there {text.count(sound)} times"
        text = text.replace(sound, faulty)
    copy_sources({file: text})
    subprocess.run(["cmake", "--preset", "fast"], cwd=COPY, check=True, capture_output=True)
    build = ["cmake", "--build", "--preset", "fast", "--parallel", str(os.cpu_count()), "--target", "mappm"]
    subprocess.run(build, cwd=COPY, check=True)


def compared(ranks: str) -> list[str]:
    words = ["compare-bits", str(SCENE), "--ranks", ranks, "--steps", "40", "--every", "20", "--build", str(BUILD)]
    finished = subprocess.run([sys.executable, "-m", "verification", *words], cwd=ROOT, capture_output=True, text=True)
    assert finished.returncode == 1, finished.stdout + finished.stderr
    print(finished.stdout)
    return finished.stdout.splitlines()


def ids_of_particles(folder: Path) -> list[int]:
    finished = run(SCENE, folder, Options(ranks=0, steps=1, overrides=("output.checkpoint=1",)))
    (checkpoint,) = (finished.folder / "checkpoints").iterdir()
    with h5py.File(checkpoint) as file:
        return [int(i) for i in file["fluid/id"]]


def test_a_dropped_ghost_is_named_as_the_missing_partner() -> None:
    plant(*DROPPED)
    lines = compared("2")
    assert lines[0] == "first difference at step 20:"
    found = re.fullmatch(
        r"first divergent step 18: (\d+) particles, \d+ solids differ; first PP (\d+), fields (.*)", lines[3]
    )
    assert found, lines
    assert int(found[1]) >= 2
    assert {"vx", "vy"} & set(found[3].split(", "))
    pairs = [line for line in lines if ": pair with " in line]
    missing = [line for line in pairs if line.endswith(": 1 times | 0 times")]
    assert missing and missing == pairs[: len(missing)]  # they are named before the others
    for line in missing:
        name = re.fullmatch(r"serial reference \| P=2, build fast: pair with PP (\d+): .*", line)
        assert name and int(name[1]) % 7 == 5, line
    for line in pairs[len(missing) :]:  # the ghost is missing from densities, and so in the pressure of pairs that are there
        assert ": 1 times" not in line and ": 0 times" not in line, line


def test_a_fault_of_the_integration_shows_equal_pairs_and_its_field(tmp_path: Path) -> None:
    kicked = [i for i in ids_of_particles(tmp_path) if i % 97 == 5]
    plant(*KICKED)
    lines = compared("1")
    assert lines[0] == "first difference at step 20:"
    assert lines[3] == (
        f"first divergent step 12: {len(kicked)} particles, 0 solids differ; first PP {min(kicked)}, fields vy"
    )
    assert lines[4].startswith(f"all pairs of PP {min(kicked)} are equal: the difference arose after")
