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
