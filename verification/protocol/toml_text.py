"""A scene as the text of a TOML file. Numbers are written so that reading gives the same bits."""

import json
import math
from collections.abc import Iterator


def value_text(value: object) -> str:
    """On one line: a number, a text, a list or a table, as an override or a line of a scene has it. Throws ValueError."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        if not math.isfinite(value):
            raise ValueError(f"{value} is no number of a scene")
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key} = {value_text(entry)}' for key, entry in value.items())}}}"
    raise ValueError(f"{value!r} is no value of a scene")


def _lines(head: str, table: dict) -> Iterator[str]:
    yield f"\n{head}"
    yield from (f"{key} = {value_text(value)}" for key, value in table.items())


def scene_text(scene: dict) -> str:
    """Of the whole scene without its table [case], which the solver ignores: the keys of the top, then a block a table."""
    lines, blocks = [], []
    for key, value in scene.items():
        if key == "case":
            continue
        if isinstance(value, dict):
            blocks += _lines(f"[{key}]", value)
        elif isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value):
            blocks += [line for entry in value for line in _lines(f"[[{key}]]", entry)]
        else:
            lines.append(f"{key} = {value_text(value)}")
    return "\n".join([*lines, *blocks]) + "\n"
