"""Parameters of a case, and the scenes that follow from them.

    [case.parameters]               # a number, a text or a list each, with its value in the scene as it stands
    phi = 0.2
    R_over_dx = 8

    [case.formulas]                 # in this order
    side = "sqrt(pi / phi)"         # a name without a dot helps those that follow
    "box.size" = "[side, side]"     # a key of the scene
    "fluid.spacing" = "1 / R_over_dx"

A text KEY=VALUE of a point, a level, a variation or --set with a KEY without a dot sets a parameter; one with a dot, or the name of
a whole table, sets the scene and wins over the formulas. Codes read plain scenes and know nothing of all this: scene_of
gives them.
"""

import copy

from verification.protocol.errors import CaseError
from verification.protocol.scene import ALTERNATIVES, parsed, set_value, with_overrides
from verification.protocol.toml_text import value_text
from verification.suite.case import Case
from verification.suite.formulas import RESERVED, evaluated, is_value, names_in

Sets = tuple[str, ...] | list[str]


def _read_defaults(table: dict, scene: dict, where: str) -> dict:
    for name, value in table.items():
        at = f"{where}.parameters.{name} = {value!r}"
        if not name.isidentifier() or name in RESERVED:
            raise CaseError(f"{at}: no name for a parameter; take letters, digits and _, and none of {', '.join(RESERVED)}")
        if name in scene:
            raise CaseError(f"{at}: the scene has a key of that name; rename the parameter")
        if not is_value(value):
            raise CaseError(f"{at}: wrong type; write a number, a text or a list of them")
    return dict(table)


def _has(scene: dict, key: str) -> bool:
    found = scene
    for part in key.split("."):
        if isinstance(found, list) and part.isdigit() and int(part) < len(found):
            found = found[int(part)]
        elif isinstance(found, dict) and part in found:
            found = found[part]
        else:
            return False
    return True


def _check_target(key: str, known: set[str], scene: dict, at: str) -> None:
    if "." in key:
        if not _has(scene, key):
            raise CaseError(f"{at}: the scene has no such key; add it to the scene or mend the name")
    elif key in known:
        raise CaseError(f"{at}: a parameter has that name; rename the helper")
    elif not key.isidentifier() or key in RESERVED or key in scene:
        raise CaseError(f"{at}: neither a key of the scene, which has a dot, nor a name for a helper; rename it")


def read_parameters(table: dict, scene: dict, where: str) -> tuple[dict, dict[str, str]]:
    """[case.parameters] and [case.formulas] of the table [case]. Throws CaseError."""
    defaults = _read_defaults(table.get("parameters", {}), scene, where)
    known, unused, formulas = set(defaults), set(defaults), table.get("formulas", {})
    for key, text in formulas.items():
        at = f"{where}.formulas.{key}"
        if not isinstance(text, str):
            raise CaseError(f"{at} = {text!r}: wrong type; write the expression as a text")
        _check_target(key, known, scene, f"{at} = {text!r}")
        read = names_in(text, at)
        if read - known:
            raise CaseError(f"{at} = {text!r}: {', '.join(sorted(read - known))}: no such name; known here are "
                            f"{', '.join(sorted(known)) or 'none'}")
        unused -= read
        if "." not in key:
            known.add(key)
            unused.add(key)
    for name in sorted(unused):
        kind = "parameters" if name in defaults else "formulas"
        raise CaseError(f"{where}.{kind}.{name} = {table[kind][name]!r}: no formula uses it; use it or remove it")
    return defaults, dict(formulas)


def _kind(value: object) -> str:
    return "list" if isinstance(value, list) else "text" if isinstance(value, str) else "number"


def split(sets: Sets, parameters: dict, scene: dict, where: str) -> tuple[dict, tuple[str, ...]]:
    """Parameters by name, and what sets the scene. Throws CaseError. Without parameters all is of the scene."""
    chosen, others = {}, []
    for text in sets:
        key, _, value = (part.strip() for part in text.partition("="))
        if not parameters or "." in key or key in scene:
            others.append(text)
        elif key not in parameters:
            raise CaseError(f"{where}: {text}: no such parameter; known are {', '.join(parameters)}; a key of the scene has a dot")
        elif not is_value(parsed(value)) or _kind(parsed(value)) != _kind(parameters[key]):
            raise CaseError(f"{where}: {text}: wrong type; write a {_kind(parameters[key])}, as {parameters[key]!r} is")
        else:
            chosen[key] = parsed(value)
    return chosen, tuple(others)


def derived(scene: dict, parameters: dict, formulas: dict[str, str], sets: Sets, where: str = "case") -> dict:
    """The whole scene of `sets`, from the plain one, which is left as it is.

    Throws CaseError; KeyError, IndexError or ValueError where a key of `sets` has no place in the scene.
    """
    chosen, overrides = split(sets, parameters, scene, where)
    names, found = parameters | chosen, copy.deepcopy(scene)
    for key, text in formulas.items():
        value = evaluated(text, names, f"{where}.formulas.{key}")
        if "." in key:
            set_value(found, key, value)
        else:
            names[key] = value
    return with_overrides(found, overrides)


def scene_of(case: Case, sets: Sets) -> dict:
    """The whole scene of a case under `sets`, which for a point begin with its own. Throws CaseError."""
    try:
        return derived(case.plain, case.parameters, case.formulas, sets, f"{case.file}: case")
    except CaseError:
        raise
    except (KeyError, IndexError, ValueError, TypeError) as error:
        raise CaseError(f"{case.file}: {' '.join(sets)}: no such key: {error}; see solver/scene/README.md") from None


def _same(one: object, other: object) -> bool:
    """Equal as the solver reads them: 1 and 1.0 are, 1 and true are not."""
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    return isinstance(one, bool) == isinstance(other, bool) and one == other


def _falls_with(key: str, table: dict, path: str) -> bool:
    """Whether the solver drops a key by itself, for its alternative is set."""
    return any(f"{path}{key}" in pair and any(f"{path}{other}" in pair for other in table) for pair in ALTERNATIVES)


def _changes(plain: object, now: object, path: str) -> list[str]:
    """Overrides KEY=VALUE that make `now` of `plain`; `path` ends with a dot, or is empty at the top."""
    if _same(plain, now):
        return []
    if isinstance(plain, list) and isinstance(now, list) and len(plain) == len(now) and all(
            isinstance(entry, dict) for entry in plain + now):
        plain, now = ({str(i): entry for i, entry in enumerate(entries)} for entries in (plain, now))
    inner = isinstance(plain, dict) and isinstance(now, dict)
    if not inner or any(key not in now and not _falls_with(key, now, path) for key in plain):
        return [f"{path[:-1]}={value_text(now)}"]
    return [text for key, value in now.items() for text in _changes(plain.get(key), value, f"{path}{key}.")]


def overrides_of(case: Case, sets: Sets) -> tuple[str, ...]:
    """Overrides of the plain scene KEY=VALUE that give the scene of `sets`; of a case without parameters `sets` themselves.

    Numbers are written so that the solver reads the same bits. Throws CaseError.
    """
    if not case.parameters and not case.formulas:
        return tuple(sets)
    return tuple(_changes(case.plain, scene_of(case, sets), ""))
