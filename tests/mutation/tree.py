"""A copy of the sources in which every fault sleeps, its build, and copies of the Python part with one fault each.

The copy lies in build/mutation/tree. Files that did not change keep their time, so that only what changed is built.
"""

import shutil
import subprocess
from collections import defaultdict
from pathlib import Path

from tests.mutation.manifest import ROOT, ManifestError, Mutant, guarded

FOLDER = ROOT / "build" / "mutation"
TREE = FOLDER / "tree"
BUILD = FOLDER / "build"
COPIED = ("CMakeLists.txt", "cmake", "solver", "bench", "tests")
BUILT_FROM = (".cpp", ".hpp", ".txt", ".cmake")
PYTHON_PART = ("verification", "reference", "cases", "tests/python", "reports/templates", "pyproject.toml")
HEADER = "solver/base/mutant.hpp"
HEADER_TEXT = """// Which fault of tests/mutation is awake: the number in MAPPM_MUTANT; none if it is not set.
#pragma once

#include <cstdlib>

namespace mappm {

inline const int active_mutant = [] {
  const char* text = std::getenv("MAPPM_MUTANT");
  return text ? std::atoi(text) : 0;
}();

inline bool mutant(int number) { return active_mutant == number; }

}  // namespace mappm
"""


class BuildError(RuntimeError):
    """The copy does not build; carries the end of the compiler's output."""


def _sources(test_files: set[str]) -> dict[str, str]:
    """Texts of the files to copy; of the C++ tests only the given ones (tests/unit/... or tests/mpi/...)."""
    texts = {}
    for name in COPIED:
        top = ROOT / name
        for path in [top] if top.is_file() else sorted(top.rglob("*")):
            relative = path.relative_to(ROOT).as_posix()
            is_test = relative.startswith(("tests/unit/", "tests/mpi/")) and path.suffix == ".cpp"
            if path.suffix in BUILT_FROM and path.is_file() and (not is_test or relative in test_files):
                texts[relative] = path.read_text()
    return texts


def write_tree(mutants: list[Mutant], test_files: set[str]) -> None:
    texts = _sources(test_files)
    by_file = defaultdict(list)
    for mutant in mutants:
        if mutant.is_compiled:
            by_file[mutant.file].append(mutant)
    for file, here in by_file.items():
        texts[file] = guarded(texts[file], here)
    texts[HEADER] = HEADER_TEXT
    for name, text in texts.items():
        path = TREE / name
        if path.exists() and path.read_text() == text:
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    for path in TREE.rglob("*"):
        if path.is_file() and path.relative_to(TREE).as_posix() not in texts:
            path.unlink()


def build_tree(targets: list[str], jobs: int) -> None:
    """Throws BuildError."""
    configure = ["cmake", "-G", "Ninja", "-S", TREE, "-B", BUILD, "-D", "CMAKE_BUILD_TYPE=Release", "-D",
                 "CMAKE_CXX_COMPILER=g++", "-D", "CMAKE_CXX_FLAGS_RELEASE=-O1 -march=native -w"]
    build = ["cmake", "--build", BUILD, "--parallel", str(jobs), "--target", *targets]
    for command in (configure, build):
        finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if finished.returncode != 0:
            raise BuildError(finished.stdout[-6000:])


def write_planted(mutant: Mutant) -> Path:
    """A copy of the Python part, with the cases and the Python tests, in which one text is replaced; its folder."""
    folder = FOLDER / "planted" / mutant.id
    shutil.rmtree(folder, ignore_errors=True)
    for name in PYTHON_PART:
        source, target = ROOT / name, folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, target)
    path = folder / mutant.file
    text = mutant.planted(path.read_text())
    if path.suffix == ".py":
        try:
            compile(text, mutant.file, "exec")
        except SyntaxError as error:  # it would be caught by every test, and prove nothing
            raise ManifestError(f"{mutant.id}: with the fault {mutant.file} is no Python: {error}") from None
    path.write_text(text)
    return folder
