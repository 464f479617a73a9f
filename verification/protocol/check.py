"""Checks the files that a run left against README.md of this folder: the first fault is one error that names file and field."""

import csv
import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any, NoReturn

import h5py
import numpy as np

from verification.protocol.capability import DIGEST, FREE_BODY
from verification.protocol.errors import OutputError

COST = ("core_seconds", "setup_core_seconds", "wall_seconds", "cores", "peak_memory")
OF_SOLIDS = ("time", "id", "position_x", "velocity_x")
KINDS = ("PolyData", "UnstructuredGrid")


def _wrong(file: Path, field: str, fault: str) -> NoReturn:
    raise OutputError(f"{file}: {field}: {fault}" if field else f"{file}: {fault}")


def check_run(folder: Path, capabilities: frozenset[str] | set[str]) -> None:
    """Throws OutputError where a file of the run is missing, truncated, of a wrong shape or not finite."""
    record = check_record(folder / "run.json", capabilities)
    scene = tomllib.loads(record["scene"]["text"])
    if (folder / "series.csv").exists():
        check_series(folder / "series.csv")
    check_snapshots(folder, len(scene["box"]["size"]))
    solids = folder / "solids.csv"
    if solids.exists():
        check_solids(solids)
    elif FREE_BODY in capabilities and _wants_solids(scene) and not record.get("quantities"):  # which it may state instead
        _wrong(solids, "", "missing, though the scene has output.solids = true")


def _wants_solids(scene: dict) -> bool:
    free = any(body.get("shape") != "wall" and body.get("motion", "free") == "free" for body in scene.get("body", []))
    return free and scene.get("output", {}).get("solids", False)


def is_number(value: Any) -> bool:
    """A finite one; True and False are none."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _text(file: Path, table: dict, key: str, name: str = "", empty: bool = False) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not (value or empty):
        _wrong(file, name or key, "missing" if key not in table else f"{value!r}: must be a text")
    return value


def check_record(file: Path, capabilities: frozenset[str] | set[str]) -> dict:
    """Reads run.json; its keys, their types, and what has to be finite."""
    if not file.exists():
        _wrong(file, "", "missing; the run did not end as a whole")
    try:
        record = json.loads(file.read_text())
    except ValueError as error:
        _wrong(file, "", f"no JSON, perhaps truncated: {error}")
    if not isinstance(record, dict):
        _wrong(file, "", "must be one JSON object")
    for key in ("code", "version", "command"):
        _text(file, record, key)
    _check_scene(file, record)
    _check_cost(file, record)
    _check_quantities(file, record)
    if "objection" in record:
        _text(file, record, "objection", empty=True)
    if DIGEST in capabilities or "digest" in record:
        _text(file, record, "digest")
    return record


def _check_scene(file: Path, record: dict) -> None:
    scene = record.get("scene")
    if not isinstance(scene, dict):
        _wrong(file, "scene", "missing or no table")
    text = _text(file, scene, "text", "scene.text")
    try:
        size = tomllib.loads(text)["box"]["size"]
    except tomllib.TOMLDecodeError as error:
        _wrong(file, "scene.text", f"no TOML: {error}")
    except (KeyError, TypeError):
        _wrong(file, "scene.text", "has no box.size")
    if not isinstance(size, list) or len(size) not in (2, 3):
        _wrong(file, "scene.text", f"box.size = {size!r}: must be two or three lengths")


def _check_cost(file: Path, record: dict) -> None:
    cost = record.get("cost")
    if not isinstance(cost, dict):
        _wrong(file, "cost", "missing or no table")
    for key in COST:
        if key not in cost:
            _wrong(file, f"cost.{key}", "missing")
        if not is_number(cost[key]) or cost[key] < 0:
            _wrong(file, f"cost.{key}", f"{cost[key]!r}: must be a finite number of at least 0")
    if not isinstance(cost["cores"], int) or cost["cores"] < 1:
        _wrong(file, "cost.cores", f"{cost['cores']!r}: must be an integer of at least 1")


def _check_quantities(file: Path, record: dict) -> None:
    quantities = record.get("quantities", {})
    if not isinstance(quantities, dict):
        _wrong(file, "quantities", "must be a table")
    for name, entry in quantities.items():
        if not isinstance(entry, dict):
            _wrong(file, f"quantities.{name}", "must be a table")
        for key in ("value", "uncertainty"):
            if not is_number(entry.get(key)):
                _wrong(file, f"quantities.{name}.{key}", f"{entry.get(key)!r}: must be a finite number")
        if entry["uncertainty"] < 0:
            _wrong(file, f"quantities.{name}.uncertainty", f"{entry['uncertainty']!r}: must be at least 0")
        _text(file, entry, "unit", f"quantities.{name}.unit", empty=True)


def _columns(file: Path) -> dict[str, list[str]]:
    """Cells of a CSV file by the name of their column, without its unit."""
    try:
        with file.open(newline="", encoding="utf-8") as opened:
            text = opened.read()
        rows = list(csv.reader(text.splitlines()))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        _wrong(file, "", f"cannot be read: {error}")
    if not rows:
        _wrong(file, "header", "missing; the file is empty")
    names = [head.partition(" [")[0] for head in rows[0]]
    for name in names:
        if not name or is_text_a_number(name):
            _wrong(file, "header", f"{name!r}: must be the name of a column")
        if names.count(name) > 1:
            _wrong(file, "header", f"{name} twice")
    if len(rows) < 2:
        _wrong(file, "", "holds no row")
    if not text.endswith("\n"):
        _wrong(file, f"line {len(rows)}", "no line break at its end; perhaps truncated")
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            _wrong(file, f"line {number}", f"{len(row)} cells under {len(names)} columns; perhaps truncated")
    return {name: list(cells) for name, cells in zip(names, zip(*rows[1:], strict=True), strict=True)}


def is_text_a_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _check_cells(file: Path, name: str, cells: list[str]) -> None:
    """Finite numbers; integers of any size where momentum is told exactly; digests are text."""
    exact = name.startswith(("momentum", "impulse"))
    for number, cell in enumerate(cells, start=2):
        if name == "digest":
            sound, wanted = bool(cell), "a text"
        elif exact:
            sound, wanted = bool(re.fullmatch(r"-?\d+", cell)), "an integer"
        else:
            sound, wanted = is_text_a_number(cell) and math.isfinite(float(cell)), "a finite number"
        if not sound:
            _wrong(file, name, f"line {number}: {cell!r}: must be {wanted}")


def _check_table(file: Path, wanted: tuple[str, ...]) -> dict[str, list[str]]:
    columns = _columns(file)
    for name in wanted:
        if name not in columns:
            _wrong(file, name, f"missing; there are {', '.join(columns)}")
    for name, cells in columns.items():
        _check_cells(file, name, cells)
    return columns


def _check_rises(file: Path, times: np.ndarray, strictly: bool) -> None:
    change = np.diff(times)
    (falls,) = np.nonzero(change <= 0 if strictly else change < 0)
    if len(falls):
        line = int(falls[0]) + 3
        _wrong(file, "time", f"line {line}: {times[line - 2]:g} after {times[line - 3]:g}: must increase")


def check_series(file: Path) -> None:
    """series.csv: a row a sample."""
    columns = _check_table(file, ("time",))
    _check_rises(file, np.array(columns["time"], dtype=float), strictly=True)


def check_solids(file: Path) -> None:
    """solids.csv: a row a body and sample."""
    columns = _check_table(file, OF_SOLIDS)
    _check_rises(file, np.array(columns["time"], dtype=float), strictly=False)


def check_snapshots(folder: Path, dimensions: int) -> None:
    """snapshots/fluid_*.vtkhdf, in the order of their numbers."""
    before = -math.inf
    for file in sorted(folder.glob("snapshots/fluid_*.vtkhdf")):
        if not re.fullmatch(r"fluid_\d{9}\.vtkhdf", file.name):
            _wrong(file, "name", "must be fluid_ and nine digits")
        try:
            with h5py.File(file) as opened:
                time = _check_snapshot(file, opened, dimensions)
        except OSError as error:
            _wrong(file, "", f"truncated, or no HDF5: {error}")
        if time <= before:
            _wrong(file, "FieldData/TimeValue", f"{time:g} after {before:g}: must increase from file to file")
        before = time


def _check_snapshot(file: Path, opened: h5py.File, dimensions: int) -> float:
    """Shapes and values of one file; its time."""
    if "VTKHDF" not in opened:
        _wrong(file, "VTKHDF", "missing")
    root = opened["VTKHDF"]
    kind = root.attrs.get("Type", b"")
    kind = kind.decode() if isinstance(kind, bytes) else str(kind)
    if kind not in KINDS:
        _wrong(file, "Type", f"{kind!r}: must be one of {', '.join(KINDS)}")
    points = _array(file, root, "Points", (None, 3))
    count = len(points)
    if int(_array(file, root, "NumberOfPoints", (1,))[0]) != count:
        _wrong(file, "NumberOfPoints", f"not the {count} of Points")
    if dimensions == 2 and np.any(points[:, 2]):
        _wrong(file, "Points", "third coordinate must be 0 in the plane")
    _array(file, root, "PointData/velocity", (count, 3))
    kinds = _array(file, root, "PointData/kind", (count,))
    if np.any((kinds != 0) & (kinds != 1)):
        _wrong(file, "PointData/kind", "must be 0 or 1")
    return float(_array(file, root, "FieldData/TimeValue", (1,))[0])


def _array(file: Path, root: h5py.Group, name: str, shape: tuple[int | None, ...]) -> np.ndarray:
    """A data set of finite numbers; None in `shape` is any length."""
    if not isinstance(root.get(name), h5py.Dataset):
        _wrong(file, name, "missing")
    values = root[name][()]
    has = np.shape(values)
    if len(has) != len(shape) or any(wanted not in (None, side) for wanted, side in zip(shape, has, strict=True)):
        _wrong(file, name, f"shape {has}: must be {tuple('n' if side is None else side for side in shape)}")
    if values.dtype.kind not in "iuf":
        _wrong(file, name, f"{values.dtype}: must be numbers")
    if not np.all(np.isfinite(values)):
        _wrong(file, name, f"{np.count_nonzero(~np.isfinite(values))} values are not finite")
    return values
