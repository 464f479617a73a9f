"""What is kept of a run beside its record: series, thinned, and the last snapshot near the middle plane, for pictures."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from verification.protocol.points import write_points
from verification.protocol.run import Run, read_points, read_time

ROWS = 1000  # of a series
LAYER = 1.5  # half the thickness of the layer that is kept of a scene in space, in spacings


def _thinned(text: str) -> str:
    """A CSV file with ROWS rows at most, the first and the last among them."""
    head, *rows = text.splitlines()
    if len(rows) > ROWS:
        rows = [rows[i] for i in np.unique(np.linspace(0, len(rows) - 1, ROWS).round().astype(int))]
    return "\n".join([head, *rows]) + "\n"


def _last_fluid(run: Run, folder: Path) -> Path:
    file = run.snapshots()[-1]
    data, box = read_points(file), run.scene["box"]["size"]
    kept = np.ones(len(data["points"]), dtype=bool)
    if len(box) == 3 and isinstance(box[2], (int, float)):
        kept = np.abs(data["points"][:, 2] - 0.5 * box[2]) < LAYER * run.scene["fluid"]["spacing"]
    kind = data["kind"][kept] if "kind" in data else None
    return write_points(folder, 0, read_time(file), data["points"][kept], data["velocity"][kept], kind, np.float32)


def kept_of(run: Run, field: bool) -> dict[str, bytes]:
    """By their names in the folder of the run; `field`: with the last snapshot."""
    found = {}
    series = run.folder / "series.csv"
    if series.exists():
        found["series.csv"] = _thinned(series.read_text()).encode()
    if field and run.snapshots():
        with TemporaryDirectory() as scratch:
            found["snapshots/fluid_000000000.vtkhdf"] = _last_fluid(run, Path(scratch)).read_bytes()
    if field and run.snapshots("solids"):
        found["snapshots/solids_000000000.vtkhdf"] = run.snapshots("solids")[-1].read_bytes()
    return found
