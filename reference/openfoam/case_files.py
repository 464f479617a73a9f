"""The dictionaries of a case: mean velocity held by a body force, walls that do not slip, second order throughout.

Interpolation is corrected for skewness, without which these meshes are first order (0.4 % off at N 32, phi 0.1).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from reference.openfoam.blocks import BODY
from reference.openfoam.cell import Cell


@dataclass(frozen=True)
class Steady:
    """simpleFoam, consistent. Convergence: the residuals, relative, of velocity and pressure."""

    relaxation: float  # of the velocity
    residual: float
    iterations: int = 20000
    program: str = "simpleFoam"


@dataclass(frozen=True)
class Transient:
    """pimpleFoam in its PISO form. Time in sides over superficial velocity."""

    step: float
    end: float
    nudge: float = 0.05  # velocity across the flow at the start, so that a flow that may shed does
    program: str = "pimpleFoam"


Solver = Steady | Transient

TOLERANCE = 1e-14
INTERPOLATION = "skewCorrected linear"


def steady_for(cell: Cell, n: int) -> Steady:
    """Relaxation found by trial: heavier where the mesh is coarse or convection matters."""
    if cell.dimension == 2:
        return Steady(0.9 if cell.reynolds >= 10 else 1 - 1.6 / n, 1e-8)
    if cell.reynolds >= 20:
        return Steady(0.9, 1e-6)  # slow to settle; the drag has to 1e-7 by then
    return Steady(1 - 0.8 / n, 1e-7)


def foam_file(kind: str, name: str, body: str) -> str:
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n{body}\n"


def write_files(folder: Path, files: dict[str, tuple[str, str]]) -> list[Path]:
    """Writes the files of a case: by path its class and body. Returns their paths."""
    for name, (kind, body) in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(foam_file(kind, file.name, body))
    return [folder / name for name in files]


def vector_text(values: Iterable[float]) -> str:
    padded = (*values, 0.0, 0.0)[:3]
    return "(" + " ".join(f"{value:.15g}" for value in padded) + ")"


def _control(solver: Solver) -> str:
    steady = isinstance(solver, Steady)
    end, step = (solver.iterations, 1) if steady else (solver.end, solver.step)
    return f"""application {solver.program};
startFrom startTime; startTime 0; stopAt endTime; endTime {end:.15g}; deltaT {step:.15g};
writeControl {"timeStep" if steady else "runTime"}; writeInterval {end:.15g}; purgeWrite 1;
writeFormat ascii; writePrecision 12; writeCompression off; timeFormat general; timePrecision 10; runTimeModifiable no;
functions {{ forces {{ type forces; libs (forces); patches ("{BODY}.*"); rho rhoInf; rhoInf 1; CofR (0 0 0);
writeControl timeStep; writeInterval 1; log no; }} }}"""


def _schemes(solver: Solver) -> str:
    steady = isinstance(solver, Steady)
    convection = f"Gauss {INTERPOLATION}"
    return f"""ddtSchemes {{ default {"steadyState" if steady else "backward"}; }}
gradSchemes {{ default Gauss {INTERPOLATION}; }}
divSchemes {{ default none; div(phi,U) {"bounded " if steady else ""}{convection};
div((nuEff*dev2(T(grad(U))))) Gauss {INTERPOLATION}; }}
laplacianSchemes {{ default Gauss linear corrected; }}
interpolationSchemes {{ default {INTERPOLATION}; }}
snGradSchemes {{ default corrected; }}"""


def _solution(solver: Solver) -> str:
    linear = f"""solvers {{
p {{ solver GAMG; smoother GaussSeidel; tolerance {TOLERANCE}; relTol 0.05; }}
pFinal {{ $p; tolerance 1e-9; relTol 0.01; }}
U {{ solver smoothSolver; smoother symGaussSeidel; tolerance {TOLERANCE}; relTol 0.1; }}
UFinal {{ $U; tolerance 1e-9; relTol 0.01; }} }}"""
    if isinstance(solver, Transient):
        return linear + """
PIMPLE { nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }"""
    return linear + f"""
SIMPLE {{ consistent yes; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0;
residualControl {{ p {solver.residual}; U {solver.residual}; }} }}
relaxationFactors {{ fields {{ p 1; }} equations {{ U {solver.relaxation:.15g}; }} }}"""


def _field(cell: Cell, solver: Solver, name: str, patches: dict[str, str]) -> str:
    speed = 1 / (1 - cell.solid)
    start = [speed * component for component in cell.direction]
    if isinstance(solver, Transient):
        start[0] -= solver.nudge * cell.direction[1]
        start[1] += solver.nudge * cell.direction[0]
    value = vector_text(start) if name == "U" else "0"
    wall = "noSlip" if name == "U" else "zeroGradient"
    lines = [
        f"{patch} {{ type {wall if kind == 'wall' else kind}; }}"  # cyclic and empty are named as their patches
        for patch, kind in patches.items()
    ]
    units = "[0 1 -1 0 0 0 0]" if name == "U" else "[0 2 -2 0 0 0 0]"
    return f"dimensions {units};\ninternalField uniform {value};\nboundaryField {{\n" + "\n".join(lines) + "\n}"


def write_case(folder: Path, cell: Cell, solver: Solver, patches: dict[str, str], block_mesh: str = "") -> list[Path]:
    """Writes all files but the mesh into an empty folder; `patches` gives the kind of each. Returns what it wrote."""
    force = f"""meanVelocity {{ type meanVelocityForce; active yes; selectionMode all; fields (U);
Ubar {vector_text([component / (1 - cell.solid) for component in cell.direction])}; relaxation 1; }}"""
    viscosity = f"transportModel Newtonian; nu {cell.viscosity:.15g};"
    files = {
        "system/controlDict": ("dictionary", _control(solver)),
        "system/fvSchemes": ("dictionary", _schemes(solver)),
        "system/fvSolution": ("dictionary", _solution(solver)),
        "constant/transportProperties": ("dictionary", viscosity),
        "constant/turbulenceProperties": ("dictionary", "simulationType laminar;"),
        "constant/fvOptions": ("dictionary", force),
        "0/U": ("volVectorField", _field(cell, solver, "U", patches)),
        "0/p": ("volScalarField", _field(cell, solver, "p", patches)),
    }
    if block_mesh:
        files["system/blockMeshDict"] = ("dictionary", block_mesh)
    return write_files(folder, files)
