"""What makes two runs the same run: the key of a run in the store."""

import hashlib
import json
from collections.abc import Mapping

from verification.codes.code import Code
from verification.protocol.capability import DIGEST

NO_MATTER = ("case", "name")  # tables and keys of a scene that say nothing about the run


def canonical(value):
    """The same for the same values: whole numbers are integers, so that 1 and 1.0 are one; NaN and infinity are refused."""
    if value is None or isinstance(value, (int, str)):  # True and False are integers, too
        return value
    if isinstance(value, Mapping):
        return {str(key): canonical(value[key]) for key in sorted(value)}
    if isinstance(value, (list, tuple)):
        return [canonical(one) for one in value]
    if value != value or value in (float("inf"), float("-inf")):
        raise ValueError(f"{value}: is no number that a scene can hold")
    return int(value) if value.is_integer() else value


def canonical_scene(scene: Mapping) -> dict:
    """Without the manifest and the name of the case."""
    return canonical({key: value for key, value in scene.items() if key not in NO_MATTER})


def hash_of(value) -> str:
    """64 hexadecimal digits."""
    return hashlib.sha256(json.dumps(canonical(value), sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def identity_of(code: Code) -> dict:
    """Of a code: results of one identity are kept together. Its numerics version where it has one, else version and adapter.

    With a numerics version the adapter does not count: it hands the scene on, and what it adds is not of the result.
    """
    if code.numerics_version is not None:
        return {"code": code.name, "numerics": code.numerics_version}
    return {"code": code.name, "version": code.version, "adapter": code.adapter}


def run_key(code: Code, scene: Mapping, steps: int | None = None, options: Mapping[str, str] = {}, cores: int = 1) -> str:
    """Of a run. Cores, and options that change the speed alone, are part of it only where a code does not promise equal bits."""
    same_bits = DIGEST in code.capabilities
    counted = {key: value for key, value in options.items() if not (same_bits and key in code.speed_options)}
    parts = {"scene": canonical_scene(scene), "steps": steps if steps is not None else "end", "options": counted}
    if not same_bits:
        parts["cores"] = cores
    return hash_of(identity_of(code) | parts)[:24]
