"""Errors that a user can mend; the command line prints them without a trace."""


class CaseError(ValueError):
    """A manifest that cannot be used: names file, key and fix."""


class SolverError(RuntimeError):
    """A run that did not end well; carries the solver's own message."""


class StoreError(RuntimeError):
    """A store that cannot be read or written: names the file, what is wrong and the fix. Nothing that it held is lost."""


class OutputError(SolverError):
    """A run that left files which are not what the protocol asks for: names file, field and fault."""


class Beyond(RuntimeError):
    """A scene that a code cannot do, or a code that is not installed: SKIPPED, for the reason it carries."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason
