"""Figures of benchmarks, asked for by their names and settings."""

from collections.abc import Iterable
from pathlib import Path

from verification.protocol.errors import StoreError
from verification.store.export import import_into
from verification.store.store import Figure, Made, Store

Setting = str | int | float


class NoFigure(StoreError, LookupError):
    """A figure that a benchmark has not: names benchmark, figure and settings, and the settings that there are."""


def words_of(settings: dict[str, Setting]) -> str:
    """For people, by key: fluid=2d_39 ranks=1."""
    return " ".join(f"{key}={settings[key]}" for key in sorted(settings))


def _place(value: Setting) -> tuple[bool, float, str]:
    """Numbers come before words."""
    return (True, 0.0, value) if isinstance(value, str) else (False, value, "")


def _order(row: Figure) -> tuple:
    return row.name, sorted((key, _place(value)) for key, value in row.settings.items())


class Figures:
    """Of one benchmark, by name and settings, numbers by size."""

    def __init__(self, bench: str, rows: Iterable[Figure]):
        """Throws ValueError where a row is of another benchmark."""
        self.bench, self.rows = bench, tuple(sorted(rows, key=_order))
        others = {row.bench for row in self.rows} - {bench}
        if others:
            raise ValueError(f"{bench}: rows are of {', '.join(sorted(others))}")
        self._rows = {self._key(row.name, row.settings): row for row in self.rows}

    @staticmethod
    def _key(name: str, settings: dict[str, Setting]) -> tuple[str, frozenset[tuple[str, Setting]]]:
        return name, frozenset(settings.items())

    @property
    def made(self) -> Made:
        """Of all of them: a benchmark is entered as a whole. Throws NoFigure where there is none."""
        if not self.rows:
            raise NoFigure(f"{self.bench}: there are no figures; make them with `python3 -m bench.{self.bench}`")
        return self.rows[0].made

    def get(self, name: str, **settings: Setting) -> float | None:
        """The value at just these settings, in the unit of its row; None where there is none."""
        found = self._rows.get(self._key(name, settings))
        return None if found is None else found.value

    def off(self, name: str, **settings: Setting) -> tuple[float, float]:
        """How far the lowest and the highest of the rounds are from the value, both at least 0; 0 for what was found once."""
        found = self._rows.get(self._key(name, settings))
        return (0.0, 0.0) if found is None or found.low is None else (found.value - found.low, found.high - found.value)

    def value(self, name: str, **settings: Setting) -> float:
        """As get; throws NoFigure in place of None."""
        found = self.get(name, **settings)
        if found is None:
            known = ", ".join(words_of(row.settings) or "none" for row in self.where(name)) or f"no {name} at all"
            raise NoFigure(f"{self.bench}: no {name} at the settings {words_of(settings) or 'none'}; there are: {known}. "
                           f"Make them with `python3 -m bench.{self.bench}`")
        return found

    def where(self, name: str, **settings: Setting) -> list[Figure]:
        """Those with these settings and any others."""
        return [row for row in self.rows if row.name == name and settings.items() <= row.settings.items()]

    def settings(self, key: str) -> list[Setting]:
        """The values of a setting that occur, each once: numbers by size, then words."""
        return sorted({row.settings[key] for row in self.rows if key in row.settings}, key=_place)


def benches_of(store: Store) -> dict[str, Figures]:
    """By benchmark."""
    rows = store.figures()
    return {bench: Figures(bench, (row for row in rows if row.bench == bench)) for bench in dict.fromkeys(row.bench for row in rows)}


def read_benches(file: Path) -> dict[str, Figures]:
    """Of an export of a store. Throws StoreError."""
    store = Store(":memory:")
    import_into(store, file)
    return benches_of(store)
