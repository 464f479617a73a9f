"""Tables of published figures, beside this file: NAME.csv, whose first lines say where the figures come from.

    # source: authors, journal, what of it
    # uncertainty: of the figures, in words; where it differs from row to row there is a column of it
    # range: where they hold
    column,column,...
"""

import csv
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent
HEADER = ("source", "uncertainty", "range")


@dataclass(frozen=True)
class Table:
    source: str
    uncertainty: str
    range: str
    rows: tuple[dict[str, str], ...]

    def column(self, name: str) -> list[float]:
        return [float(row[name]) for row in self.rows]


def _header(lines: list[str], name: str) -> dict[str, str]:
    """A line that begins with none of the keys goes on with the one before."""
    found: dict[str, str] = {}
    for line in (line.removeprefix("#").strip() for line in lines):
        key, colon, text = line.partition(": ")
        if colon and key in HEADER:
            found[key] = text
        elif found:
            found[list(found)[-1]] += " " + line
    missing = [key for key in HEADER if key not in found]
    if missing:
        raise ValueError(f"{name}.csv: the header lacks {', '.join(missing)}; add the line")
    return found


def read_table(name: str) -> Table:
    lines = (FOLDER / f"{name}.csv").read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return Table(**_header(comments, name), rows=tuple(rows))
