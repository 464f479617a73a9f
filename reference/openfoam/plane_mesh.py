"""Unstructured mesh of a periodic square of side 1 with discs cut out, made by gmsh (Geuzaine and Remacle 2009).

Four-sided cells, one layer deep. The width at the surfaces is a quarter of a circle over N, and grows to a multiple of
that in between, the same on all levels. Opposite sides carry the same points, so that they become cyclic patches.
"""

import math
from pathlib import Path

import numpy as np

from reference.openfoam.blocks import BODY
from reference.openfoam.case_files import foam_file
from reference.openfoam.run import run

PROGRAMS = ("gmsh", "gmshToFoam", "createPatch")
RAW = "raw_"  # before the names of the patches that gmsh makes
WIDEST = 2.0  # width between the bodies over that at the surface
KINDS = {"x_low": "cyclic", "x_high": "cyclic", "y_low": "cyclic", "y_high": "cyclic", BODY: "wall",
         "front_and_back": "empty"}


def width_at_surface(radius: float, n: int) -> float:
    return math.pi * radius / (2 * n)


def geometry(positions: np.ndarray, radius: float, n: int) -> str:
    """Input of gmsh. positions: (m, 2), from a corner of the square, of discs that do not meet its sides."""
    fine = width_at_surface(radius, n)
    coarse = WIDEST * fine
    on_side = math.ceil(1 / coarse) + 1
    lines = [f"Point({i + 1}) = {{{x}, {y}, 0}};" for i, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)])]
    lines += [f"Line({i + 1}) = {{{i + 1}, {(i + 1) % 4 + 1}}};" for i in range(4)]
    lines += [f"Transfinite Curve {{1:4}} = {on_side};", "Periodic Curve {2} = {-4};", "Periodic Curve {3} = {-1};"]
    lines.append("Curve Loop(1) = {1, 2, 3, 4};")
    for body, (x, y) in enumerate(positions):
        first = 10 * (body + 1)
        around = [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)]
        lines += [
            f"Point({first + i}) = {{{x + radius * a:.15g}, {y + radius * b:.15g}, 0}};"
            for i, (a, b) in enumerate(around)
        ]
        lines += [f"Circle({first + i}) = {{{first + i}, {first}, {first + i % 4 + 1}}};" for i in range(1, 5)]
        lines.append(f"Transfinite Curve {{{first + 1}:{first + 4}}} = {n + 1};")
        lines.append(f"Curve Loop({first}) = {{{first + 1}:{first + 4}}};")
    bodies = [10 * (body + 1) for body in range(len(positions))]
    circles = ", ".join(f"{first + 1}:{first + 4}" for first in bodies)
    lines += [
        f"Plane Surface(1) = {{1, {', '.join(map(str, bodies))}}};",
        f"Field[1] = Distance; Field[1].CurvesList = {{{circles}}}; Field[1].NumPointsPerCurve = {4 * n};",
        f"Field[2] = Threshold; Field[2].InField = 1; Field[2].SizeMin = {fine}; Field[2].SizeMax = {coarse};",
        f"Field[2].DistMin = 0; Field[2].DistMax = {radius / 2};",
        "Background Field = 2; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;",
        "Mesh.Algorithm = 6; Mesh.RecombinationAlgorithm = 1; Mesh.Smoothing = 10; Recombine Surface {1};",
        "out[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; };",  # top, volume, then a side for each curve
    ]
    sides = {"y_low": "out[2]", "x_high": "out[3]", "y_high": "out[4]", "x_low": "out[5]",
             BODY: ", ".join(f"out[{6 + i}]" for i in range(4 * len(positions))), "front_and_back": "1, out[0]"}
    lines += [f'Physical Surface("{RAW}{name}") = {{{faces}}};' for name, faces in sides.items()]
    lines.append('Physical Volume("fluid") = {out[1]};')
    return "\n".join(lines) + "\n"


def patch_dict() -> str:
    """The body of system/createPatchDict: gives the patches of gmsh their kinds, and matches those that are cyclic."""
    entries = []
    for name, kind in KINDS.items():
        other = {"low": "high", "high": "low"}.get(name[2:], "")
        neighbour = f"neighbourPatch {name[:2]}{other}; " if kind == "cyclic" else ""
        entries.append(
            f"{{ name {name}; patchInfo {{ type {kind}; {neighbour}}} constructFrom patches; patches ({RAW}{name}); }}"
        )
    return "pointSync false;\npatches (\n" + "\n".join(entries) + "\n);"


def kinds(_bodies: int) -> dict[str, str]:
    """The patches of the mesh."""
    return KINDS


def write_input(folder: Path, positions: np.ndarray, radius: float, n: int) -> list[Path]:
    """Writes what `make_mesh` reads. Returns the files."""
    files = [folder / "mesh.geo", folder / "system/createPatchDict"]
    files[0].write_text(geometry(positions, radius, n))
    files[1].write_text(foam_file("dictionary", files[1].name, patch_dict()))
    return files


def make_mesh(folder: Path) -> float:
    """Makes the mesh in a case that has all else. Returns the core-seconds. Throws FailedRun."""
    seconds = run(folder, "gmsh", "-3", "-nt", "1", "-format", "msh2", "mesh.geo", "-o", "mesh.msh")
    return seconds + run(folder, "gmshToFoam", "mesh.msh") + run(folder, "createPatch", "-overwrite")
