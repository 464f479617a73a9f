"""Folders that look like those of a run and hold exact fields, for tests of measures."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from verification.protocol.run import Run


@dataclass(frozen=True)
class Snapshot:
    time: float
    points: np.ndarray  # (n, 2)
    velocity: np.ndarray  # (n, 2)


@dataclass(frozen=True)
class Fields:
    """What the run is to hold: the text of its scene, columns of series.csv and solids.csv, and snapshots of PPs."""

    scene: str
    series: dict[str, np.ndarray] = field(default_factory=dict)
    solids: dict[str, np.ndarray] = field(default_factory=dict)
    snapshots: tuple[Snapshot, ...] = ()


def _table(path: Path, columns: dict[str, np.ndarray]) -> None:
    rows = zip(*columns.values(), strict=True)
    path.write_text("\n".join([",".join(columns), *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n")


def _in_space(plane: np.ndarray) -> np.ndarray:
    return np.column_stack([plane, np.zeros(len(plane))])


def synthetic_run(folder: Path, fields: Fields) -> Run:
    (folder / "snapshots").mkdir(parents=True)
    (folder / "run.json").write_text(json.dumps({"scene": {"text": fields.scene}}))
    for name in ("series", "solids"):
        if columns := getattr(fields, name):
            _table(folder / f"{name}.csv", columns)
    for i, snapshot in enumerate(fields.snapshots):
        with h5py.File(folder / "snapshots" / f"fluid_{i:09}.vtkhdf", "w") as file:
            file["VTKHDF/Points"] = _in_space(snapshot.points)
            file["VTKHDF/PointData/velocity"] = _in_space(snapshot.velocity)
            file["VTKHDF/PointData/kind"] = np.zeros(len(snapshot.points), dtype=np.uint8)
            file["VTKHDF/FieldData/TimeValue"] = np.array([snapshot.time])
    return Run(folder)


def scattered(count: int, size: tuple[float, float], seed: int = 1) -> np.ndarray:
    """(about count, 2): a lattice that fills a rectangle from the origin, moved at random by a fifth of its spacing."""
    spacing = np.sqrt(size[0] * size[1] / count)
    axes = [spacing * (np.arange(round(side / spacing)) + 0.5) for side in size]
    lattice = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    return lattice + 0.2 * spacing * np.random.default_rng(seed).uniform(-1, 1, lattice.shape)
