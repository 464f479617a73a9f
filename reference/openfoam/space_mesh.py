"""Unstructured mesh of a periodic cube of side 1 with spheres cut out, made by snappyHexMesh.

Cubes, 2 N along an edge, halved within a quarter of a radius of the spheres, whose
surface the points there are moved to.
"""

from pathlib import Path

import numpy as np

from reference.openfoam.blocks import BODY, block_mesh_dict, box_mesh
from reference.openfoam.case_files import foam_file
from reference.openfoam.run import run

PROGRAMS = ("blockMesh", "snappyHexMesh")
REFINED = 1  # times that cells are halved at a surface; with 2 the order falls to 1.5
QUALITY = """maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4; maxConcave 80; minVol 1e-20;
minTetQuality -1e30; minArea -1; minTwist 0.02; minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01;
minTriangleTwist -1; nSmoothScale 4; errorReduction 0.75;"""


def kinds(bodies: int) -> dict[str, str]:
    """The patches of the mesh."""
    sides = {f"{axis}_{end}": "cyclic" for axis in "xyz" for end in ("low", "high")}
    return sides | {f"{BODY}_{i}": "wall" for i in range(bodies)}


def point_in_fluid(positions: np.ndarray) -> np.ndarray:
    """(3,) far from all bodies, and on no face of a regular mesh."""
    tries = np.random.default_rng(1).uniform(0.1, 0.9, (1000, 3))
    distance = np.linalg.norm(tries[:, None, :] - positions[None, :, :], axis=2).min(axis=1)
    return tries[np.argmax(distance)]


def snappy_dict(positions: np.ndarray, radius: float) -> str:
    def vector(values) -> str:
        return "(" + " ".join(f"{value:.15g}" for value in values) + ")"

    names = [f"{BODY}_{i}" for i in range(len(positions))]
    spheres = " ".join(
        f"{name} {{ type searchableSphere; centre {vector(position)}; radius {radius:.15g}; }}"
        for name, position in zip(names, positions, strict=True)
    )
    surfaces = " ".join(f"{name} {{ level ({REFINED} {REFINED}); patchInfo {{ type wall; }} }}" for name in names)
    regions = " ".join(f"{name} {{ mode distance; levels (({radius / 4:.6g} {REFINED})); }}" for name in names)
    return f"""castellatedMesh true; snap true; addLayers false;
geometry {{ {spheres} }}
castellatedMeshControls {{ maxLocalCells 10000000; maxGlobalCells 10000000; minRefinementCells 0;
nCellsBetweenLevels 2; features (); refinementSurfaces {{ {surfaces} }} resolveFeatureAngle 30;
refinementRegions {{ {regions} }} locationInMesh {vector(point_in_fluid(positions))};
allowFreeStandingZoneFaces true; }}
snapControls {{ nSmoothPatch 5; tolerance 2; nSolveIter 50; nRelaxIter 5; nFeatureSnapIter 0; }}
addLayersControls {{ relativeSizes true; layers {{}} expansionRatio 1; finalLayerThickness 0.5; minThickness 0.1;
nGrow 0; featureAngle 60; nRelaxIter 3; nSmoothSurfaceNormals 1; nSmoothNormals 3; nSmoothThickness 10;
maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3; minMedianAxisAngle 90; nBufferCellsNoExtrude 0;
nLayerIter 50; }}
meshQualityControls {{ {QUALITY} }}
mergeTolerance 1e-6;"""


def write_input(folder: Path, positions: np.ndarray, radius: float, n: int) -> list[Path]:
    """Writes what `make_mesh` reads. Returns the files."""
    bodies = {"blockMeshDict": block_mesh_dict(box_mesh(2 * n)), "snappyHexMeshDict": snappy_dict(positions, radius)}
    files = [folder / "system" / name for name in bodies]
    for file in files:
        file.write_text(foam_file("dictionary", file.name, bodies[file.name]))
    return files


def make_mesh(folder: Path) -> float:
    """Makes the mesh in a case that has all else. Returns the core-seconds. Throws FailedRun."""
    return run(folder, "blockMesh") + run(folder, "snappyHexMesh", "-overwrite")
