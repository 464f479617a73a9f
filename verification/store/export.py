"""A store as text that git can hold: JSON lines, sorted, a row each, and back."""

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path

from verification.protocol.errors import StoreError
from verification.store.store import FORMAT, Store

PARSED = ("scene", "options", "record", "ledger", "data", "settings")  # columns that hold JSON


def _line(value) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def _head(rows: int, number: int = FORMAT) -> dict:
    """The first line; the number of rows tells an export that was cut off."""
    return {"store": "MaPPM", "format": number, "rows": rows}


RUN_FOLDER = re.compile(r"[^\s\"'=\\]*/runs/[0-9a-f]{24}[^/\s\"'\\]*/?")  # of the laboratory that made a run, which is gone


def without_folders(text: str) -> str:
    """A command or a message as it reads in any laboratory."""
    return RUN_FOLDER.sub("", text)


def _row_line(table: str, row: dict) -> str:
    kept = {name: json.loads(value) if name in PARSED else value for name, value in row.items() if value is not None}
    return without_folders(_line({table: kept}))


def export(store: Store, file: Path) -> int:
    """Writes the file whole or not at all; returns its number of rows."""
    part, rows = file.with_name(file.name + ".part"), [_row_line(table, row) for table, row in store.tables()]
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with part.open("w") as lines:
            lines.write("\n".join([_line(_head(len(rows))), *rows]) + "\n")
            lines.flush()
            os.fsync(lines.fileno())
        part.replace(file)
    except OSError as error:
        if part.is_file():
            part.unlink()
        raise StoreError(f"{file}: {error.strerror}; free some space, or name another file") from None
    return len(rows)


def _rows(file: Path) -> Iterator[tuple[str, dict]]:
    lines = file.read_text(errors="replace").splitlines() or [""]
    for number, line in enumerate(lines, start=1):
        try:
            entry = json.loads(line)
            if number == 1:
                if entry not in [_head(len(lines) - 1, known) for known in range(1, FORMAT + 1)]:
                    raise ValueError(f"the first line is not {_line(_head(len(lines) - 1))}, of so many rows as follow")
                continue
            ((table, row),) = entry.items()
            values = {name: _line(value) if name in PARSED else value for name, value in row.items()}
        except (ValueError, AttributeError) as error:
            raise StoreError(f"{file}:{number}: {error}; this is no export of a store, or it is cut off: take it again from "
                             "where it came from. Nothing was entered") from None
        yield table, values


def import_into(store: Store, file: Path) -> int:
    """Enters the rows that are not there yet, all or nothing; returns how many."""
    if not file.exists():
        raise StoreError(f"{file}: no such file; name one that `store export` wrote")
    return store.enter_rows(_rows(file))
