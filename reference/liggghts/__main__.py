"""LIGGGHTS as a reference: python3 -m reference.liggghts PROBLEM --scene FILE [--set KEY=VALUE]... --out DIR [options]."""

import argparse
import shlex
import sys
import tomllib
from pathlib import Path

from reference.liggghts import fall, impact, sph
from reference.liggghts.program import Failed, installed, missing
from verification.protocol.quantity import Result, write_result
from verification.protocol.scene import read_scene


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="python3 -m reference.liggghts", description=__doc__.partition(":")[0])
    problems = top.add_subparsers(dest="problem", required=True)
    for name, module in (("fall", fall), ("impact", impact), ("rest", impact), ("sph", sph)):
        problem = problems.add_parser(name, help=module.__doc__.partition("\n")[0])
        problem.add_argument("--scene", type=Path, required=module is impact, help="case.toml of the solver")
        problem.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the scene")
        problem.add_argument("--out", type=Path, required=True, help="folder of result.json")
        module.add_options(problem)
    return top


def scene_of(options: argparse.Namespace) -> dict:
    """Throws ValueError naming file, key and fix."""
    if options.scene is None:
        return {}
    try:
        return read_scene(options.scene, options.set)
    except OSError as error:
        raise ValueError(f"{options.scene}: {error.strerror}; give the file of a scene") from None
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{options.scene}: no TOML: {error}") from None
    except (KeyError, IndexError, TypeError) as error:
        raise ValueError(f"{options.scene}: --set names a key that is not there: {error}") from None


def solve(options: argparse.Namespace, command: str) -> Result:
    """Throws ValueError on bad input, installed or not, and Failed where LIGGGHTS fails."""
    scene = scene_of(options)
    if options.problem == "fall":
        fallen = fall.fall_of(options, scene)
        return fall.run(fallen, options.out, command) if installed() else missing(command)
    if options.problem == "sph":
        fluid = sph.fluid_of(options)
        return sph.run(fluid, options.out, command) if installed() else missing(command)
    try:
        bodies = impact.read_scene_of(scene, options.problem)
    except ValueError as error:
        raise ValueError(f"{options.scene}: {error}") from None
    return impact.run(bodies, options.out, command, options.problem) if installed() else missing(command)


def main(arguments: list[str]) -> int:
    options = parser().parse_args(arguments)
    command = shlex.join(["python3", "-m", "reference.liggghts", *arguments])
    try:
        result = solve(options, command)
    except ValueError as error:
        print(f"reference.liggghts: {error}", file=sys.stderr)
        return 2
    except Failed as error:
        print(f"reference.liggghts: LIGGGHTS failed: {error}", file=sys.stderr)
        return 1
    write_result(result, options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
