"""The store: one SQLite file that keeps runs, what was measured of them, and what they took.

A run is entered whole or not at all, and so is what one measure found of it: each is one transaction, and several
processes may share a file. Times are rows of their own, one a repeat and machine. NaN is kept as NULL.
"""

import json
import math
import sqlite3
import threading
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from verification.protocol.errors import StoreError
from verification.protocol.quantity import Measured

APPLICATION = 0x4D615050  # marks a file as a store
FORMAT = 2
WAIT = 120.0  # seconds for another process that writes

TABLES = """
CREATE TABLE runs (key TEXT PRIMARY KEY, label TEXT, code TEXT, version TEXT, numerics INTEGER, scene TEXT, steps INTEGER,
                   options TEXT, record TEXT, ledger TEXT, made TEXT, machine TEXT, source TEXT, command TEXT);
CREATE TABLE files (key TEXT, name TEXT, data BLOB, PRIMARY KEY (key, name));
CREATE TABLE measured (key TEXT, measure TEXT, name TEXT, value REAL, uncertainty REAL, objection TEXT,
                       PRIMARY KEY (key, measure, name));
CREATE TABLE charts (key TEXT, measure TEXT, kind TEXT, data TEXT, PRIMARY KEY (key, measure, kind));
CREATE TABLE costs (key TEXT, machine TEXT, cores INTEGER, made TEXT, core_seconds REAL, setup_core_seconds REAL,
                    wall_seconds REAL, peak_memory INTEGER, PRIMARY KEY (key, machine, cores, made));
CREATE TABLE matrices (key TEXT PRIMARY KEY, label TEXT, data TEXT, made TEXT, machine TEXT, source TEXT);
CREATE TABLE refusals (key TEXT PRIMARY KEY, label TEXT, code TEXT, reason TEXT);
CREATE TABLE figures (bench TEXT, settings TEXT, name TEXT, value REAL, unit TEXT, made TEXT, machine TEXT, source TEXT,
                      command TEXT, low REAL, high REAL, PRIMARY KEY (bench, settings, name));
"""
LATER = {1: ("ALTER TABLE figures ADD COLUMN low REAL", "ALTER TABLE figures ADD COLUMN high REAL")}  # makes of a format the next
EXPORTED = ("runs", "measured", "costs", "matrices", "refusals", "figures")  # what git may hold; files and charts stay here


@dataclass(frozen=True)
class Made:
    """Where a figure comes from."""

    made: str  # date and time, UTC
    machine: str
    source: str  # commit
    command: str = ""

    @property
    def when(self) -> str:
        """To the second, for people."""
        return self.made[:19]


@dataclass(frozen=True)
class Cost:
    """What a run took."""

    core_seconds: float  # without its set-up
    setup_core_seconds: float
    wall_seconds: float
    cores: int
    peak_memory: int  # bytes


@dataclass(frozen=True)
class Ledger:
    """Mass and momentum of a run as equalities of integers, at every sample."""

    samples: int
    defects: tuple[str, ...] = ()


@dataclass(frozen=True)
class StoredRun:
    """A run as it is kept. `numerics` is None for a code without such a version."""

    key: str
    label: str  # for people: the case, and what was set
    code: str
    version: str
    numerics: int | None
    scene: dict
    steps: int | None  # None: to its end
    options: dict[str, str]
    record: dict  # run.json
    made: Made
    ledger: Ledger | None = None  # of a code that has one
    cost: Cost | None = None


@dataclass(frozen=True)
class Found:
    """What one measure found of a run."""

    values: dict[str, Measured] = field(default_factory=dict)
    charts: dict[str, list] = field(default_factory=dict)  # by kind, as JSON


@dataclass(frozen=True)
class Figure:
    """One figure of a benchmark, at its settings."""

    bench: str
    settings: dict[str, str | int | float]
    name: str
    value: float  # the median over rounds, where there were several
    made: Made
    unit: str = ""
    low: float | None = None  # over the rounds; None for what was found once
    high: float | None = None

    @property
    def words(self) -> str:
        """Value, and range over the rounds."""
        return f"{self.value:.4g}" + ("" if self.low is None else f" ({self.low:.4g} to {self.high:.4g})")


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _text(value) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


class Store:
    """An open store. Every call is one transaction; all throw StoreError."""

    def __init__(self, file: Path | str):
        self.file, self._alone = file, threading.RLock()
        if file != ":memory:":
            Path(file).parent.mkdir(parents=True, exist_ok=True)
        with self._told():
            self._connection = sqlite3.connect(file, timeout=WAIT, isolation_level=None, check_same_thread=False)
            self._connection.execute("PRAGMA busy_timeout = 120000")
            if not self._connection.execute("SELECT name FROM sqlite_master").fetchall():
                self._create()
            self._check()

    def _create(self) -> None:
        self._connection.execute("BEGIN IMMEDIATE")
        if not self._connection.execute("SELECT name FROM sqlite_master").fetchall():  # another process may have been first
            for statement in TABLES.split(";"):
                self._connection.execute(statement)
            self._connection.execute(f"PRAGMA application_id = {APPLICATION}")
            self._connection.execute(f"PRAGMA user_version = {FORMAT}")
        self._connection.execute("COMMIT")

    def _bring_up_to_date(self) -> None:
        """A file of an older format, all or nothing; another process may have been first."""
        self._connection.execute("BEGIN IMMEDIATE")
        (number,) = self._connection.execute("PRAGMA user_version").fetchone()
        for older in range(number, FORMAT):
            for statement in LATER[older]:
                self._connection.execute(statement)
        self._connection.execute(f"PRAGMA user_version = {FORMAT}")
        self._connection.execute("COMMIT")

    def _check(self) -> None:
        (mark,) = self._connection.execute("PRAGMA application_id").fetchone()
        (number,) = self._connection.execute("PRAGMA user_version").fetchone()
        if mark != APPLICATION:
            raise StoreError(f"{self.file}: is a database of something else; name another file")
        if number in LATER:
            self._bring_up_to_date()
        elif number != FORMAT:
            raise StoreError(f"{self.file}: is a store of format {number}, and this program writes format {FORMAT}; export it "
                             "with the program that made it, and import that into a new file")

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Errors of SQLite, in the words of a user."""
        try:
            yield
        except sqlite3.Error as error:
            fix = "free some space and go on: nothing that it held is lost" if "full" in str(error) else \
                "move it aside, and make it anew or from an export" if isinstance(error, sqlite3.DatabaseError) and \
                not isinstance(error, sqlite3.OperationalError) else "see that the folder can be written, and go on"
            raise StoreError(f"{self.file}: {error}; {fix}") from None

    @contextmanager
    def _change(self) -> Iterator[sqlite3.Connection]:
        """One transaction: all of it or nothing."""
        with self._alone, self._told():
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                raise

    def _rows(self, query: str, *values) -> list[tuple]:
        with self._alone, self._told():
            return self._connection.execute(query, values).fetchall()

    def close(self) -> None:
        self._connection.close()

    # Runs.

    def enter(self, run: StoredRun, files: Mapping[str, bytes] = {}) -> None:
        """In place of an earlier one of the same key; what was measured of that goes with it where its digest is another."""
        before = self.run(run.key)
        made = run.made
        row = (run.key, run.label, run.code, run.version, run.numerics, _text(run.scene), run.steps, _text(run.options),
               _text(run.record), None if run.ledger is None else _text([run.ledger.samples, run.ledger.defects]), made.made,
               made.machine, made.source, made.command)
        with self._change() as change:
            if before is not None and before.record.get("digest") != run.record.get("digest"):
                for table in ("measured", "charts"):
                    change.execute(f"DELETE FROM {table} WHERE key = ?", (run.key,))
            change.execute(f"INSERT OR REPLACE INTO runs VALUES ({','.join('?' * len(row))})", row)
            self._enter_files(change, run.key, files)
            if run.cost is not None:
                self._enter_cost(change, run.key, run.cost, made)

    @staticmethod
    def _enter_files(change: sqlite3.Connection, key: str, files: Mapping[str, bytes]) -> None:
        change.execute("DELETE FROM files WHERE key = ?", (key,))
        change.executemany("INSERT INTO files VALUES (?, ?, ?)", [(key, name, zlib.compress(data, 6)) for name, data in files.items()])

    def enter_files(self, key: str, files: Mapping[str, bytes]) -> None:
        """In place of those that are kept of a run."""
        with self._change() as change:
            self._enter_files(change, key, files)

    @staticmethod
    def _enter_cost(change: sqlite3.Connection, key: str, cost: Cost, made: Made) -> None:
        change.execute("INSERT OR REPLACE INTO costs VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                       (key, made.machine, cost.cores, made.made, cost.core_seconds, cost.setup_core_seconds, cost.wall_seconds,
                        cost.peak_memory))

    def enter_cost(self, key: str, cost: Cost, made: Made) -> None:
        """A repeat."""
        with self._change() as change:
            self._enter_cost(change, key, cost, made)

    def run(self, key: str) -> StoredRun | None:
        rows = self._rows("SELECT * FROM runs WHERE key = ?", key)
        return self._run(rows[0]) if rows else None

    def runs(self, code: str | None = None) -> list[StoredRun]:
        """By code, version and label."""
        query = "SELECT * FROM runs WHERE code = ?1 OR ?1 IS NULL ORDER BY code, numerics, version, label, key"
        return [self._run(row) for row in self._rows(query, code)]

    def _run(self, row: tuple) -> StoredRun:
        (key, label, code, version, numerics, scene, steps, options, record, ledger, *made) = row
        costs = self.costs(key)
        counted = None
        if ledger is not None:
            samples, defects = json.loads(ledger)
            counted = Ledger(samples, tuple(defects))
        return StoredRun(key, label, code, version, numerics, json.loads(scene), steps, json.loads(options), json.loads(record),
                         Made(*made), counted, costs[-1][1] if costs else None)

    def costs(self, key: str) -> list[tuple[Made, Cost]]:
        """Of all repeats, the oldest first."""
        rows = self._rows("SELECT made, machine, core_seconds, setup_core_seconds, wall_seconds, cores, peak_memory FROM costs "
                          "WHERE key = ? ORDER BY made", key)
        return [(Made(made, machine, ""), Cost(*numbers)) for made, machine, *numbers in rows]

    def files(self, key: str) -> dict[str, bytes]:
        return {name: zlib.decompress(data) for name, data in self._rows("SELECT name, data FROM files WHERE key = ?", key)}

    def has_files(self, key: str) -> bool:
        """Not of a run that was imported."""
        return bool(self._rows("SELECT 1 FROM files WHERE key = ? LIMIT 1", key))

    # What was measured.

    def enter_found(self, key: str, measure: str, found: Found) -> None:
        rows = [(key, measure, name, one.value, one.uncertainty, one.objection) for name, one in found.values.items()]
        with self._change() as change:
            change.executemany("INSERT OR REPLACE INTO measured VALUES (?, ?, ?, ?, ?, ?)", rows)
            change.executemany("INSERT OR REPLACE INTO charts VALUES (?, ?, ?, ?)",
                               [(key, measure, kind, _text(data)) for kind, data in found.charts.items()])

    def found(self, key: str, measure: str) -> Found:
        rows = self._rows("SELECT name, value, uncertainty, objection FROM measured WHERE key = ? AND measure = ?", key, measure)
        charts = self._rows("SELECT kind, data FROM charts WHERE key = ? AND measure = ?", key, measure)
        return Found({name: Measured(_number(value), _number(error), words) for name, value, error, words in rows},
                     {kind: json.loads(data) for kind, data in charts})

    def all_found(self, key: str) -> list[tuple[str, str, Measured]]:
        """(measure, name, value) of every measure, current or not."""
        rows = self._rows("SELECT measure, name, value, uncertainty, objection FROM measured WHERE key = ? ORDER BY measure, name", key)
        return [(measure, name, Measured(_number(value), _number(error), words)) for measure, name, value, error, words in rows]

    # Equality of bits.

    def enter_matrix(self, key: str, label: str, data: dict, made: Made) -> None:
        with self._change() as change:
            change.execute("INSERT OR REPLACE INTO matrices VALUES (?, ?, ?, ?, ?, ?)",
                           (key, label, _text(data), made.made, made.machine, made.source))

    def matrix(self, key: str) -> tuple[dict, Made] | None:
        rows = self._rows("SELECT data, made, machine, source FROM matrices WHERE key = ?", key)
        return (json.loads(rows[0][0]), Made(*rows[0][1:])) if rows else None

    # What a code cannot do.

    def enter_refusal(self, key: str, label: str, code: str, reason: str) -> None:
        with self._change() as change:
            change.execute("INSERT OR REPLACE INTO refusals VALUES (?, ?, ?, ?)", (key, label, code, reason))

    def refusal(self, key: str) -> str:
        """Why the code did not take this scene; empty where it did, or was not asked."""
        rows = self._rows("SELECT reason FROM refusals WHERE key = ?", key)
        return rows[0][0] if rows else ""

    def forget_refusals(self) -> None:
        with self._change() as change:
            change.execute("DELETE FROM refusals")

    # Benchmarks.

    def enter_figures(self, figures: Iterable[Figure]) -> None:
        """In place of all earlier figures of the same benchmarks."""
        figures = list(figures)
        rows = [(one.bench, _text(one.settings), one.name, one.value, one.unit, one.made.made, one.made.machine, one.made.source,
                 one.made.command, one.low, one.high) for one in figures]
        with self._change() as change:
            change.executemany("DELETE FROM figures WHERE bench = ?", [(bench,) for bench in {one.bench for one in figures}])
            change.executemany("INSERT INTO figures VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", rows)

    def figures(self, bench: str | None = None) -> list[Figure]:
        rows = self._rows("SELECT * FROM figures WHERE bench = ?1 OR ?1 IS NULL ORDER BY rowid", bench)
        return [Figure(name_of, json.loads(settings), name, _number(value), Made(*made), unit, low, high)
                for name_of, settings, name, value, unit, *made, low, high in rows]

    # As a whole.

    def tables(self) -> Iterator[tuple[str, dict]]:
        """Rows to export, (table, row), sorted: runs without files and charts."""
        for table in EXPORTED:
            with self._told():
                cursor = self._connection.execute(f"SELECT * FROM {table}")
                names = [column[0] for column in cursor.description]
                rows = cursor.fetchall()
            for row in sorted(rows, key=_text):
                yield table, dict(zip(names, row, strict=True))

    def enter_rows(self, rows: Iterable[tuple[str, dict]]) -> int:
        """Of an export; rows that are here already stay as they are, and of a benchmark those that were made later, all of
        them. Returns how many were new. All or nothing."""
        entered = 0
        with self._change() as change:
            made = dict(change.execute("SELECT bench, max(made) FROM figures GROUP BY bench").fetchall())
            for table, row in rows:
                if table not in EXPORTED:
                    raise StoreError(f"{table}: is no table of a store; known are {', '.join(EXPORTED)}")
                if table == "figures" and row["bench"] in made:
                    if row["made"] <= made[row["bench"]]:
                        continue
                    change.execute("DELETE FROM figures WHERE bench = ? AND made < ?", (row["bench"], row["made"]))
                if table == "runs":
                    self._check_digest(change, row)
                names = ", ".join(row)
                cursor = change.execute(f"INSERT OR IGNORE INTO {table} ({names}) VALUES ({','.join('?' * len(row))})",
                                        tuple(row.values()))
                entered += cursor.rowcount
        return entered

    def _check_digest(self, change: sqlite3.Connection, row: dict) -> None:
        """Throws StoreError where the same run has another digest here: what was measured of the one is not of the other."""
        here = change.execute("SELECT record FROM runs WHERE key = ?", (row.get("key"),)).fetchone()
        if here is not None and json.loads(here[0]).get("digest") != json.loads(row["record"]).get("digest"):
            raise StoreError(f"{self.file}: {row['label']}: the digest is another one here: results changed without a new numerics "
                             f"version of {row['code']}; raise that version, or import into another store. Nothing was entered")

    def remove(self, keys: Iterable[str]) -> int:
        """Runs and all that was measured of them. Returns how many runs went."""
        gone = 0
        with self._change() as change:
            for key in keys:
                gone += change.execute("DELETE FROM runs WHERE key = ?", (key,)).rowcount
                for table in ("files", "measured", "charts", "costs"):
                    change.execute(f"DELETE FROM {table} WHERE key = ?", (key,))
        with self._told():
            self._connection.execute("VACUUM")
        return gone
