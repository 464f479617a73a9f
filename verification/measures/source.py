"""Which sources a measure is made of: an edited measure measures anew."""

import ast
import functools
import hashlib
from pathlib import Path

from verification.protocol.machine import ROOT

OWN = ("verification.measures", "verification.protocol", "reference", "cases")


def _file(module: str) -> Path | None:
    """Of a module of this repository that measures may be made of."""
    if not module.startswith(OWN):
        return None
    path = ROOT.joinpath(*module.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.exists()), None)


def _imports(file: Path) -> set[Path]:
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module, *(f"{node.module}.{name.name}" for name in node.names)]
        else:
            continue
        found |= {path for name in names if (path := _file(name)) is not None}
    return found


@functools.cache
def sources_of(folder: Path) -> tuple[Path, ...]:
    """Of the measures of the case in a folder: its measure.py, the measures that all cases share, and all that these import."""
    own = folder / "measure.py"
    waiting = [file for file in (own, ROOT / "verification" / "measures" / "observables.py") if file.exists()]
    seen = set(waiting)
    while waiting:
        fresh = _imports(waiting.pop()) - seen
        seen |= fresh
        waiting += fresh
    return tuple(sorted(seen))


@functools.cache
def measure_id(folder: Path) -> str:
    """16 hexadecimal digits: of the sources, and of the data beside measure.py."""
    whole = hashlib.sha256()
    for file in (*sources_of(folder), *sorted(folder.glob("*.csv"))):
        whole.update(file.name.encode() + b"\0" + file.read_bytes())
    return whole.hexdigest()[:16]
