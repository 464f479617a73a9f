"""Which room of verification/ may import which (verification/README.md). Oracles: the arrows of that page, and the imports as they
stand."""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BELOW = ("protocol", "codes", "store", "measures", "bits", "suite", "studies", "report")  # from the lowest to the highest
BLIND = {"measures": {"codes"}, "report": {"codes"}}  # a measure and the report never know a code


def imported(file: Path) -> set[str]:
    """Modules that a file imports, anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {f"{node.module}.{name.name}" for name in node.names}
    return found


def rooms(modules: set[str]) -> set[str]:
    return {parts[1] for parts in (name.split(".") for name in modules) if parts[0] == "verification" and parts[1] in BELOW}


def test_a_room_imports_itself_and_those_below() -> None:
    wrong = []
    for place, room in enumerate(BELOW):
        for file in (ROOT / "verification" / room).glob("**/*.py"):
            allowed = set(BELOW[: place + 1]) - BLIND.get(room, set())
            wrong += [f"{file.relative_to(ROOT)} imports from {other}" for other in sorted(rooms(imported(file)) - allowed)]
    assert not wrong, "\n".join(wrong)


def test_every_module_is_in_a_room() -> None:
    folder = ROOT / "verification"
    assert {path.name for path in folder.glob("*.py")} == {"__init__.py", "__main__.py"}
    assert {path.name for path in folder.iterdir() if path.is_dir() and path.name != "__pycache__"} == set(BELOW)


def test_measures_of_cases_and_references_know_no_code() -> None:
    """measure.py of a case sees what a run left, whoever made it; meshes and exact solutions need no more than the protocol."""
    wrong = [f"{file.relative_to(ROOT)} imports from {', '.join(sorted(found))}" for pattern, allowed in
             (("cases/*/measure.py", {"protocol", "measures"}), ("reference/**/*.py", {"protocol"}))
             for file in ROOT.glob(pattern) if (found := rooms(imported(file)) - allowed)]
    assert not wrong, "\n".join(wrong)
