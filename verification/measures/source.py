"""Which sources a measure is made of: an edited measure measures anew."""

import functools
from pathlib import Path

from verification.protocol.machine import ROOT
from verification.protocol.sources import checksum_of_sources, sources_of

PACKAGES = ("verification.measures", "verification.protocol", "reference", "cases")
SHARED = "verification/measures/observables.py"


@functools.cache
def measure_id(folder: Path) -> str:
    """16 hexadecimal digits: of measure.py of the case in a folder, of the measures that all cases share, of all that these
    import, and of the data beside measure.py."""
    files = tuple(file for file in (folder / "measure.py", ROOT / SHARED) if file.exists())
    return checksum_of_sources((*sources_of(files, PACKAGES), *folder.glob("*.csv")))[:16]
