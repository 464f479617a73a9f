"""Tables that a run writes: series.csv and solids.csv."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Table:
    """Columns by name, without their units; `units` keeps these. Integer columns beyond 53 bits and digests are text."""

    columns: dict[str, np.ndarray]
    units: dict[str, str]

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self.columns[name]
        except KeyError:
            raise KeyError(f"no column {name!r}; there are {', '.join(self.columns)}") from None

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))


def read_table(path: Path) -> Table:
    """Reads a CSV file whose header reads `name [unit],name,...`."""
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        raise ValueError(f"{path} holds no row")
    columns, units = {}, {}
    for head, cells in zip(rows[0], zip(*rows[1:], strict=True), strict=True):
        name, _, unit = head.partition(" [")
        units[name] = unit.rstrip("]")
        text = name == "digest" or name.startswith(("momentum", "impulse"))
        columns[name] = np.array(cells, dtype=str if text else float)
    return Table(columns, units)


def first_difference(tables: dict[str, Table]) -> tuple[int, dict[str, str]] | None:
    """The first sampled step at which digests differ, with the digest of each; None where all agree on every row.

    Tables of different length differ at the first step that one of them lacks.
    """
    digests = {name: dict(zip(table["step"].astype(int), table["digest"], strict=True)) for name, table in tables.items()}
    for step in sorted(set().union(*digests.values())):
        at_step = {name: rows.get(step, "no row") for name, rows in digests.items()}
        if len(set(at_step.values())) > 1:
            return step, at_step
    return None
