"""The documents: lines that fit, links that lead somewhere, and one version in all of them."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from verification.protocol.machine import ROOT

WIDTH = 120
GENERATED = {ROOT / "reports" / folder / "summary.md" for folder in ("published", "out")}
FOLDERS = ("solver", "verification", "cases", "reference", "tests", "bench", "reports")
DOCUMENTS = sorted({*ROOT.glob("*.md"), *(path for name in FOLDERS for path in (ROOT / name).rglob("*.md"))}
                   - GENERATED)


def prose(text: str) -> Iterator[str]:
    """Lines that can be broken: not those of tables and of code."""
    in_code = False
    for line in text.splitlines():
        in_code ^= line.startswith("```")
        if not in_code and not line.startswith(("|", "    ")):
            yield line


def test_the_readme_fits() -> None:
    assert [line for line in (ROOT / "README.md").read_text().splitlines() if len(line) > WIDTH] == []


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_prose_fits_and_links_lead_somewhere(path: Path) -> None:
    text = path.read_text()
    assert [line for line in prose(text) if len(line) > WIDTH] == []
    for target in re.findall(r"\]\(([^)#\s]+)\)", text):
        assert target.startswith("https://") or (path.parent / target).exists(), target


def test_the_version_is_the_same_everywhere() -> None:
    version = re.search(r"^project\(MaPPM VERSION ([0-9.]+) ", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    released = re.findall(r"^## \[([0-9.]+)\] - \d{4}-\d\d-\d\d$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert released[0] == version
