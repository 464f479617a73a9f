"""Where the figures of a report come from."""

import hashlib
import importlib.metadata
import platform
import subprocess
from datetime import UTC, datetime
from pathlib import Path

from verification.protocol.machine import ROOT, processor
from verification.suite.manifest import cases_folder

PACKAGES = ("numpy", "h5py", "matplotlib", "Jinja2")


def provenance(record: dict) -> dict[str, str]:
    """Of the programs that made a run, from its record, and of what draws."""
    return {
        "commit": record["commit"],
        "numerics version": record["numerics_version"],
        "compiler": f"{record['compiler']}, {record['flags']}, {record['instruction_set']}",
        "host": f"{record['host']}, {processor()}",
        "system": platform.platform(),
        "Open MPI": subprocess.run(["mpirun", "--version"], capture_output=True, text=True).stdout.splitlines()[0],
        "Python": ", ".join(
            [platform.python_version(), *(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)]
        ),
        "date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
    }


def checksum(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def reference_checksums() -> dict[str, str]:
    """SHA-256 of every file of reference data."""
    files = [*(ROOT / "reference").rglob("*.csv"), *(ROOT / "reference").rglob("*.json"), *cases_folder().glob("*/*.csv")]
    return {str(file.relative_to(ROOT)): checksum(file) for file in sorted(files) if file.is_relative_to(ROOT)}
