"""A store as text that git can hold: JSON lines, sorted, a row each, and back."""

import json
import os
from collections.abc import Iterator
from pathlib import Path

from verification.protocol.errors import StoreError
from verification.store.store import FORMAT, Store

HEAD = {"store": "MaPPM", "format": FORMAT}
PARSED = ("scene", "options", "record", "ledger", "data", "settings")  # columns that hold JSON


def _line(value) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def export(store: Store, file: Path) -> int:
    """Writes the file whole or not at all; returns its number of rows."""
    part, rows = file.with_name(file.name + ".part"), 0
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with part.open("w") as lines:
            lines.write(_line(HEAD) + "\n")
            for table, row in store.tables():
                kept = {name: json.loads(value) if name in PARSED and value is not None else value for name, value in row.items()}
                lines.write(_line({table: {name: value for name, value in kept.items() if value is not None}}) + "\n")
                rows += 1
            lines.flush()
            os.fsync(lines.fileno())
        part.replace(file)
    except OSError as error:
        if part.is_file():
            part.unlink()
        raise StoreError(f"{file}: {error.strerror}; free some space, or name another file") from None
    return rows


def _rows(file: Path) -> Iterator[tuple[str, dict]]:
    for number, line in enumerate(file.read_text(errors="replace").splitlines() or [""], start=1):
        try:
            entry = json.loads(line)
            if number == 1:
                if entry != HEAD:
                    raise ValueError(f"the first line is not {_line(HEAD)}")
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
