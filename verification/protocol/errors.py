"""Errors that a user can mend; the command line prints them without a trace."""

from typing import NoReturn


class CaseError(ValueError):
    """A manifest that cannot be used: names file, key and fix."""


class SolverError(RuntimeError):
    """A run that did not end well; carries the solver's own message."""


class StoreError(RuntimeError):
    """A store that cannot be read or written: names the file, what is wrong and the fix. Nothing that it held is lost."""


class Killed(SolverError):
    """A run that a signal ended: made again, it may end well."""


class OutputError(SolverError):
    """A run that left files which are not what the protocol asks for: names file, field and fault."""


class Beyond(RuntimeError):
    """A scene that a code cannot do, or a code that is not installed: SKIPPED, for the reason it carries."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


def refuse(where: str, key: str, value: object, fix: str) -> NoReturn:
    """Throws the CaseError of a key in a table of a manifest; `where` is the place of the table, "file: table"."""
    raise CaseError(f"{where}.{key} = {value!r}: {fix}")


def last_line(text: str) -> str:
    """Of what a program said or an error says: the line that counts."""
    lines = text.strip().splitlines()
    return lines[-1] if lines else ""
