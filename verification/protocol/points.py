"""Writes the fluid at a time as the protocol wants it: a VTKHDF file of points, which ParaView opens."""

from pathlib import Path

import h5py
import numpy as np


def write_points(out: Path, number: int, time: float, points: np.ndarray, velocity: np.ndarray, kind: np.ndarray | None = None,
                 type_of_numbers: type = float) -> Path:
    """Writes out/snapshots/fluid_NUMBER.vtkhdf.

    points (n, D), velocity (n, D), D = 2 or 3, in the units of the scene; kind (n), 0 for the fluid, by default all of it.
    `type_of_numbers` is that of points and velocities in the file.
    """
    file = out / "snapshots" / f"fluid_{number:09d}.vtkhdf"
    file.parent.mkdir(parents=True, exist_ok=True)
    count = len(points)

    def in_space(values: np.ndarray) -> np.ndarray:
        return np.column_stack([values, np.zeros((count, 3 - values.shape[1]))]).astype(type_of_numbers)

    with h5py.File(file, "w") as whole:
        root = whole.create_group("VTKHDF")
        root.attrs["Version"] = (2, 0)
        root.attrs.create("Type", b"PolyData", dtype="S8")
        root["NumberOfPoints"] = np.array([count])
        root["Points"] = in_space(points)
        for name in ("Vertices", "Lines", "Polygons", "Strips"):
            cells = root.create_group(name)
            has = count if name == "Vertices" else 0
            cells["NumberOfCells"] = np.array([has])
            cells["NumberOfConnectivityIds"] = np.array([has])
            cells["Connectivity"] = np.arange(has)
            cells["Offsets"] = np.arange(has + 1)
        data = root.create_group("PointData")
        data["velocity"] = in_space(velocity)
        data["kind"] = np.zeros(count, dtype=np.uint8) if kind is None else np.asarray(kind, dtype=np.uint8)
        root.create_group("FieldData")["TimeValue"] = np.array([time])
    return file
