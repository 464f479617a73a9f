"""LAMMPS (Thompson et al. 2022) as a program: found in the environment of the peers, run in a folder, its figures kept."""

from pathlib import Path

from reference.scripted import PEERS, Finished, peer_version, run_in
from verification.protocol.quantity import Result

CODE = "LAMMPS"
SCRIPT = "in.lammps"
MISSING = "LAMMPS is not in .venv-peers; ./setup --peers"


def program() -> Path | None:
    return next(PEERS.glob("lib/python3*/site-packages/lammps/lmp"), None)


def installed() -> bool:
    return program() is not None


def version() -> str:
    return peer_version("lammps")


def missing(command: str) -> Result:
    return Result(CODE, command=command, missing=MISSING)


def run_script(script: str, folder: Path, ranks: int = 1) -> Finished:
    """Writes the script into `folder` and runs it there, under the MPI that came with it. Throws Failed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / SCRIPT).write_text(script)
    launch = [str(PEERS / "bin" / "mpiexec"), "-np", str(ranks)] if ranks > 1 else []
    environment = {"LD_LIBRARY_PATH": str(PEERS / "lib"), "OMP_NUM_THREADS": "1"}
    return run_in(folder, [*launch, str(program()), "-in", SCRIPT, "-log", "none"], r"LAMMPS \(([^)]+)\)", environment)
