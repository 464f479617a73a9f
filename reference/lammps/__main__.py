"""LAMMPS as a peer for speed: python3 -m reference.lammps sph [--dimension 2|3] [--side N] [--steps N] --out DIR."""

import argparse
import shlex
import sys
from pathlib import Path

from reference.lammps import sph
from reference.lammps.program import installed, missing
from reference.scripted import Failed
from verification.protocol.quantity import write_result


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="python3 -m reference.lammps", description=__doc__.partition(":")[0])
    problem = top.add_subparsers(dest="problem", required=True).add_parser("sph", help=sph.__doc__.partition("\n")[0])
    problem.add_argument("--out", type=Path, required=True, help="folder of result.json")
    sph.add_options(problem)
    return top


def main(arguments: list[str]) -> int:
    options = parser().parse_args(arguments)
    command = shlex.join(["python3", "-m", "reference.lammps", *arguments])
    try:
        fluid = sph.fluid_of(options)
        result = sph.run(fluid, options.out, command) if installed() else missing(command)
    except ValueError as error:
        print(f"reference.lammps: {error}", file=sys.stderr)
        return 2
    except Failed as error:
        print(f"reference.lammps: LAMMPS failed: {error}", file=sys.stderr)
        return 1
    write_result(result, options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
