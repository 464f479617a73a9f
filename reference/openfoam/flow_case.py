"""The dictionaries of a case that is a scene: pimpleFoam on a regular mesh, second order in space and time, nothing limited."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.openfoam.blocks import BlockMesh, block_mesh_dict, brick_mesh
from reference.openfoam.case_files import vector_text, write_files
from reference.openfoam.room import Room

PROGRAM = "pimpleFoam"
OUTER = 2  # times that momentum and pressure are solved in a step: with one, fluxes would lag and be of first order in time
CORRECTORS = 2  # pressures each time: with one, the iteration diverges where friction is strong, nu dt / h^2 above about 0.5
COUPLING = 1  # of fluxes to the velocities of the steps before; by default it is limited, and of less than first order in time


@dataclass(frozen=True)
class FlowCase:
    """What a case adds to its room: kinematic viscosity, acceleration (D), velocity (n, D) of the cells at the start, and
    steps, of which every so many are written."""

    room: Room
    viscosity: float
    gravity: np.ndarray
    start: np.ndarray
    step: float
    steps: int
    every: int


def _control(case: FlowCase) -> str:
    return f"""application {PROGRAM};
startFrom startTime; startTime 0; stopAt endTime; endTime {case.steps * case.step:.15g}; deltaT {case.step:.15g};
writeControl timeStep; writeInterval {case.every}; purgeWrite 0; writeFormat ascii; writePrecision 12;
writeCompression off; timeFormat general; timePrecision 12; runTimeModifiable no; adjustTimeStep no;"""


SCHEMES = f"""ddtSchemes {{ default backward {COUPLING}; }}
gradSchemes {{ default Gauss linear; }}
divSchemes {{ default none; div(phi,U) Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }}
laplacianSchemes {{ default Gauss linear orthogonal; }}
interpolationSchemes {{ default linear; }}
snGradSchemes {{ default orthogonal; }}"""

SOLUTION = f"""solvers {{
"p|pFinal" {{ solver GAMG; smoother GaussSeidel; tolerance 1e-6; relTol 0.01; }}
U {{ solver PBiCGStab; preconditioner DILU; tolerance 1e-11; relTol 0.01; }}
UFinal {{ $U; relTol 0; }} }}
PIMPLE {{ nOuterCorrectors {OUTER}; nCorrectors {CORRECTORS}; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }}"""


def _list(values: np.ndarray) -> str:
    """As many vectors as cells."""
    return f"nonuniform List<vector> {len(values)}\n(\n" + "\n".join(map(vector_text, values.tolist())) + "\n)\n"


def _walls(room: Room) -> dict[str, str]:
    """Conditions of the velocity by patch."""
    return {f"{'xyz'[axis]}_{end}": f"fixedValue; value uniform {vector_text(velocity)}"
            for axis, both in room.walls.items() for end, velocity in zip(("low", "high"), both, strict=True)}


def _field(units: str, inner: str, mesh: BlockMesh, on_walls: dict[str, str]) -> str:
    lines = [f"{name} {{ type {on_walls.get(name, patch.kind)}; }}" for name, patch in mesh.patches.items()]
    return f"dimensions {units};\ninternalField {inner};\nboundaryField {{\n" + "\n".join(lines) + "\n}"


def _force(gravity: np.ndarray) -> str:
    return f"""force {{ type vectorSemiImplicitSource; active yes; selectionMode all; volumeMode specific;
injectionRateSuSp {{ U ({vector_text(gravity)} 0); }} }}"""


def write_flow_case(folder: Path, case: FlowCase) -> list[Path]:
    """Writes all files into an empty folder. Returns them."""
    mesh, walls = brick_mesh(case.room.size, case.room.cells, set(case.room.walls)), _walls(case.room)
    files = {
        "system/blockMeshDict": ("dictionary", block_mesh_dict(mesh)),
        "system/controlDict": ("dictionary", _control(case)),
        "system/fvSchemes": ("dictionary", SCHEMES),
        "system/fvSolution": ("dictionary", SOLUTION),
        "constant/transportProperties": ("dictionary", f"transportModel Newtonian; nu {case.viscosity:.15g};"),
        "constant/turbulenceProperties": ("dictionary", "simulationType laminar;"),
        "0/U": ("volVectorField", _field("[0 1 -1 0 0 0 0]", _list(case.start), mesh, walls)),
        "0/p": ("volScalarField", _field("[0 2 -2 0 0 0 0]", "uniform 0", mesh, dict.fromkeys(walls, "zeroGradient"))),
    }
    if np.any(case.gravity):
        files["constant/fvOptions"] = ("dictionary", _force(case.gravity))
    return write_files(folder, files)
