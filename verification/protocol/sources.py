"""Which files of this repository a Python file is made of: those that it imports, and those that these import."""

import ast
import functools
import hashlib
import threading
from collections.abc import Iterable
from pathlib import Path

from verification.protocol.machine import ROOT

DATA = (".py", ".csv", ".json")
_PARSING = threading.Lock()  # threads that parse at a time fail in Python 3.11


def _modules(file: Path) -> set[str]:
    """Names that a file imports, anywhere in it; of `from a import b` both a and a.b, whichever is a module."""
    with _PARSING:
        tree = ast.parse(file.read_text())
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return found


def _imports(file: Path, packages: tuple[str, ...]) -> set[Path]:
    places = [ROOT.joinpath(*name.split(".")) for name in _modules(file) if f"{name}.".startswith(tuple(f"{one}." for one in packages))]
    return {path for place in places for path in (place.with_suffix(".py"), place / "__init__.py") if path.is_file()}


def _beside(file: Path) -> set[Path]:
    """Of a module in a folder of reference/: what else lies there, such as tables and programs that are not imported."""
    if not file.is_relative_to(ROOT / "reference") or file.parent == ROOT / "reference":
        return set()
    folder = ROOT / "reference" / file.relative_to(ROOT / "reference").parts[0]
    return {path for path in folder.rglob("*") if path.suffix in DATA}


@functools.cache
def sources_of(files: tuple[Path, ...], packages: tuple[str, ...]) -> tuple[Path, ...]:
    """The files, all that they import from these packages, directly or not, and the data that come with references."""
    seen, waiting = set(files), [file for file in files if file.suffix == ".py"]
    while waiting:
        file = waiting.pop()
        fresh = (_imports(file, packages) | _beside(file)) - seen
        seen |= fresh
        waiting += [path for path in fresh if path.suffix == ".py"]
    return tuple(sorted(seen))


def checksum_of_sources(files: Iterable[Path]) -> str:
    """SHA-256 over names and contents, in the order of the names; names of files in this repository are relative to it."""
    named = {str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else path.name: path for path in files}
    whole = hashlib.sha256()
    for name, path in sorted(named.items()):
        whole.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return whole.hexdigest()
