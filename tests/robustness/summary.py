"""The summary of the robustness campaigns, which the report reads: a table a campaign."""

import json
import os
import shlex
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

from verification.solver import ROOT


def _commit() -> str:
    return subprocess.run(
        ["git", "describe", "--always", "--dirty", "--abbrev=12"], cwd=ROOT, capture_output=True, text=True
    ).stdout.strip()


def write(path: Path, campaign: str, program: str, figures: dict) -> None:
    """Replaces the table of one campaign in the file; the others stay. `program` was called with these arguments."""
    summary = json.loads(path.read_text()) if path.exists() else {}
    command = f"{program} {shlex.join(sys.argv[1:])}"
    date = datetime.now(UTC).isoformat(timespec="seconds")
    summary[campaign] = {"command": command, "commit": _commit(), "date": date, **figures}
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(summary, indent=2) + "\n")
    os.replace(partial, path)
