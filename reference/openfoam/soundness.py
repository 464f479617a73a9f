"""Whether the OpenFOAM that is installed can be used: a case of one cell with one function object, which takes half a second.

That of Debian 13 (1912.200626-3) ends in each program that reads a function object, as its SHA-1 stream does not go with the
standard library that it was built with.
"""

import functools
import os
import subprocess
import tempfile
from pathlib import Path

HEAD = "FoamFile { version 2.0; format ascii; class dictionary; object any; }\n"
FILES = {
    "system/controlDict": "application postProcess; startTime 0; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;\n",
    "system/fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} snGradSchemes {}\n",
    "system/fvSolution": "",
    "system/blockMeshDict": """vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (1 1 1) simpleGrading (1 1 1));
edges (); boundary ();
""",
}


@functools.cache
def fault_of_openfoam(environment: tuple[tuple[str, str], ...]) -> str:
    """Why it cannot be used, one sentence; empty where it can. `environment` are variables that its programs need."""
    with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
        for name, text in FILES.items():
            file = Path(folder) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(HEAD + text)
        for line in (["blockMesh"], ["postProcess", "-func", "writeCellCentres"]):
            done = subprocess.run(line, cwd=folder, env=os.environ | dict(environment) | {"PWD": folder}, capture_output=True, text=True)
            if done.returncode != 0:
                words = " ".join((done.stdout + done.stderr).split())
                return f"the OpenFOAM that is installed fails on a case of one cell ({' '.join(line)}): {words[max(0, words.find('FATAL')):][:160]}"
    return ""
