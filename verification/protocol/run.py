"""What a run left in its folder: series, fields of points, and its record."""

import json
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

from verification.protocol.series import Table, read_table


@dataclass(frozen=True)
class Run:
    """A finished run."""

    folder: Path

    @cached_property
    def series(self) -> Table:
        return read_table(self.folder / "series.csv")

    @cached_property
    def record(self) -> dict:
        return json.loads((self.folder / "run.json").read_text())

    @cached_property
    def scene(self) -> dict:
        """The scene as it was run, overrides applied."""
        return tomllib.loads(self.record["scene"]["text"])

    def snapshots(self, kind: str = "fluid") -> list[Path]:
        """Files in the order of their steps; kind is "fluid" (PPs and FPs) or "solids" (a point a ball)."""
        return sorted(self.folder.glob(f"snapshots/{kind}_*.vtkhdf"))

    def fluid(self, which: int = -1) -> dict[str, np.ndarray]:
        """The PPs of a snapshot, the last by default: points (n, 3), velocity (n, 3), density ...; scene units."""
        data = read_points(self.snapshots()[which])
        return {name: values[data["kind"] == 0] for name, values in data.items()}

    def solids(self, which: int = -1) -> dict[str, np.ndarray]:
        """The balls of a snapshot, the last by default: points (n, 3), radius (n) ...; scene units."""
        return read_points(self.snapshots("solids")[which])


def read_points(path: Path) -> dict[str, np.ndarray]:
    """Points and point data of a VTKHDF file."""
    with h5py.File(path) as file:
        group = file["VTKHDF"]
        return {"points": group["Points"][:]} | {name: data[:] for name, data in group["PointData"].items()}


def read_time(path: Path) -> float:
    """Of a VTKHDF file, scene units."""
    with h5py.File(path) as file:
        return float(file["VTKHDF/FieldData/TimeValue"][0])
