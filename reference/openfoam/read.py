"""Reads what OpenFOAM wrote: logs, forces and fields, in ASCII."""

import re
from pathlib import Path

import numpy as np

GRADIENT = re.compile(r"Pressure gradient source: uncorrected Ubar = (\S+), pressure gradient = (\S+)")
VOLUME = re.compile(r"Total volume = (\S+?)\.\s")
UNIFORM_SCALAR = re.compile(r"^internalField\s+uniform\s+([^;\s(]+);", re.MULTILINE)
UNIFORM = re.compile(r"^internalField\s+uniform\s+\(([^)]*)\)", re.MULTILINE)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def gradients(folder: Path, program: str) -> np.ndarray:
    """(n,) force on the fluid per mass, one for each time step or iteration: the last of each."""
    found = []
    for line in (folder / f"log.{program}").open():
        if line.startswith("Time = "):
            found.append(np.nan)
        elif (match := GRADIENT.match(line)) and found:
            found[-1] = float(match[2])
    return np.array(found)


def volume(folder: Path) -> float:
    """Of the fluid, from the log of checkMesh."""
    return float(VOLUME.search((folder / "log.checkMesh").read_text())[1])


def version(folder: Path, program: str) -> str:
    """For example "1912"."""
    match = re.search(r"OPENFOAM=(\w+)", (folder / f"log.{program}").read_text())
    return match[1] if match else ""


def converged(folder: Path, program: str) -> bool:
    return "solution converged" in (folder / f"log.{program}").read_text()


def forces(folder: Path) -> np.ndarray:
    """(n, 4) time and the force of the fluid on the body per density, pressure and friction together."""
    rows = []
    for line in (folder / "postProcessing/forces/0/force.dat").open():
        if not line.startswith("#"):
            rows.append([float(number) for number in line.replace("(", " ").replace(")", " ").split()[:4]])
    return np.array(rows)


def times(folder: Path) -> list[Path]:
    """The folders of all times, in no order."""
    return [path for path in folder.iterdir() if path.is_dir() and NUMBER.fullmatch(path.name)]


def latest(folder: Path) -> Path:
    """The folder of the last time."""
    return max(times(folder), key=lambda path: float(path.name))


def vectors(file: Path, cells: int = 1) -> np.ndarray:
    """(cells, 3) the inner values of a vector field; `cells` counts where they are all the same."""
    text = file.read_text()
    if uniform := UNIFORM.search(text):
        return np.tile(np.array(uniform[1].split(), float), (cells, 1))
    start = text.index("nonuniform List<vector>")
    begin = text.index("(", start)
    end = text.index("\n)", begin)
    inner = text[begin + 1 : end].replace("(", " ").replace(")", " ")
    return np.array(inner.split(), float).reshape(-1, 3)


def scalars(file: Path, cells: int = 1) -> np.ndarray:
    """(cells,) the inner values of a scalar field; `cells` counts where they are all the same."""
    text = file.read_text()
    if uniform := UNIFORM_SCALAR.search(text):
        return np.full(cells, float(uniform[1]))
    begin = text.index("(", text.index("nonuniform List<scalar>"))
    return np.array(text[begin + 1 : text.index("\n)", begin)].split(), float)
