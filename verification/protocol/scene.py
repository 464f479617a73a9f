"""A scene as a reference code reads it: the TOML file that the solver gets, with the same overrides."""

import tomllib
from pathlib import Path

# Units that scenes are written in, beside bare numbers.
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "kg/m3": 1.0, "m/s": 1.0, "m/s2": 1.0,
         "rad/s": 1.0, "Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "Pa s": 1.0, "N/m": 1.0}


def in_si(quantity: float | str) -> float:
    """A number of a scene, or a text such as "10 mm". Throws KeyError on a unit that is not known."""
    if isinstance(quantity, (int, float)):
        return float(quantity)
    number, _, unit = quantity.partition(" ")
    return float(number) * UNITS[unit]


def _quantity_fault(key: str, value: object) -> str:
    """Why a value is no positive quantity; empty where it is one."""
    try:
        sound = not isinstance(value, bool) and in_si(value) > 0
    except (AttributeError, KeyError, ValueError):
        return f"{key} = {value!r}: must be a number, or a text such as \"10 mm\""
    return "" if sound else f"{key} = {value!r}: must be positive"


def fault_of(scene: dict) -> str:
    """What no code could use a scene with, by key, value and fix; empty where the keys that all need are there."""
    for name in ("box", "fluid"):
        if not isinstance(scene.get(name), dict):
            return f"{name}: missing; add a table"
    size = scene["box"].get("size")
    if not isinstance(size, list) or len(size) not in (2, 3):
        return f"box.size = {size!r}: must be two or three lengths"
    fluid = scene["fluid"]
    needed = ("density", "spacing", *(("viscosity",) if fluid.get("particles", True) else ()))
    for key in needed:
        if key not in fluid:
            return f"fluid.{key}: missing; add it"
    for place, body in enumerate(scene.get("body", [])):
        if not isinstance(body.get("shape"), str):
            return f"body.{place}.shape: missing; add it"
        if body.get("motion", "free") not in ("fixed", "moving", "free"):
            return f"body.{place}.motion = {body['motion']!r}: must be fixed, moving or free"
    named = [("box.size", side) for side in size] + [(f"fluid.{key}", fluid[key]) for key in needed]
    return next(filter(None, (_quantity_fault(key, value) for key, value in named)), "")


# Keys of which a scene gives one: an override of either replaces the other.
ALTERNATIVES = (("fluid.sound_speed", "fluid.sound_speed_factor"), ("run.step", "run.step_factor"), ("run.steps", "run.duration"))


def parsed(text: str):
    """The value of an override, as TOML; a bare word is a text."""
    text = text.strip()
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def set_value(scene: dict, key: str, value) -> None:
    """Sets one key, such as body.0.radius, as with_overrides does."""
    *way, last = key.split(".")
    table = scene
    for part in way:
        table = table[int(part)] if isinstance(table, list) else table.setdefault(part, {})
    table[int(last) if isinstance(table, list) else last] = value
    for pair in ALTERNATIVES:
        if key in pair:
            other, dropped = pair[1 - pair.index(key)].split(".")
            scene.get(other, {}).pop(dropped, None)


def with_overrides(scene: dict, overrides: list[str] | tuple[str, ...]) -> dict:
    """Sets KEY=VALUE, a key such as body.0.radius, in the dictionary of a scene, which is changed and returned.

    Throws KeyError or IndexError where a table or list on the way does not exist.
    """
    for override in overrides:
        key, _, value = override.partition("=")
        set_value(scene, key.strip(), parsed(value))
    return scene


def read_scene(file: Path, overrides: list[str] | tuple[str, ...] = ()) -> dict:
    return with_overrides(tomllib.loads(file.read_text()), overrides)
