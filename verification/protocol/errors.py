"""Errors that a user can mend; the command line prints them without a trace."""


class CaseError(ValueError):
    """A manifest that cannot be used: names file, key and fix."""


class SolverError(RuntimeError):
    """A run that did not end well; carries the solver's own message."""


class StoreError(RuntimeError):
    """A store that cannot be read or written: names the file, what is wrong and the fix. Nothing that it held is lost."""
