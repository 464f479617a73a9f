"""Who may include whom in solver/ (solver/README.md). Oracles: the arrows of that page, and the includes as they stand."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOLVER = ROOT / "solver"
MAY_INCLUDE = {
    "base": set(),
    "physics": {"base"},
    "particles": {"physics", "base"},
    "scene": {"particles", "physics", "base"},
    "serial": {"particles", "physics", "base"},
    "parallel": {"particles", "physics", "base"},
    "output": {"particles", "physics", "base"},
    "library": {"serial", "scene", "output", "particles", "physics", "base"},
    "app": {"serial", "parallel", "scene", "output", "particles", "physics", "base"},
}
# A law is written over any number type: lanes, and lists of pairs in them, belong to the fast engine.
LANES = "base/lanes.hpp"
ENGINE_LAYERS = {"parallel"}
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def includes() -> dict[str, list[str]]:
    """Of each file of the solver the files of it that it includes; names from solver/."""
    files = [path for path in SOLVER.rglob("*.[ch]pp")]
    named = {path.relative_to(SOLVER).as_posix(): INCLUDE.findall(path.read_text()) for path in files}
    return {name: [other for other in others if "/" in other] for name, others in named.items()}


def layer(file: str) -> str:
    return file.split("/")[0]


def reached(file: str, all_includes: dict[str, list[str]]) -> set[str]:
    """What a file includes, directly or not."""
    seen: set[str] = set()
    waiting = [file]
    while waiting:
        for other in all_includes.get(waiting.pop(), []):
            if other not in seen:
                seen.add(other)
                waiting.append(other)
    return seen


def test_a_layer_includes_itself_and_those_below() -> None:
    wrong = [f"{file} includes {other}" for file, others in includes().items() for other in others
             if layer(other) not in MAY_INCLUDE[layer(file)] | {layer(file)}]
    assert includes() and not wrong, wrong


def test_only_the_fast_engine_knows_lanes() -> None:
    all_includes = includes()
    wrong = [file for file in all_includes if layer(file) in MAY_INCLUDE.keys() - ENGINE_LAYERS - {"app"}
             and LANES in reached(file, all_includes)]
    assert not wrong, wrong


def test_only_the_communicator_includes_mpi() -> None:
    holders = [path.relative_to(SOLVER).as_posix() for path in SOLVER.rglob("*.[ch]pp")
               if "#include <mpi.h>" in path.read_text()]
    assert holders == ["parallel/communicator.cpp"]
