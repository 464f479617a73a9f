"""Input that the caller can mend."""


class InputError(Exception):
    """One line: file, key, value, fix."""
