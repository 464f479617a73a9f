"""The points of a map: two axes of positive numbers, and points added where neighbours came out differently."""

import math
from collections import defaultdict
from collections.abc import Mapping

CLOSEST = 1.1  # ratio of neighbours between which nothing is added


def is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def place_of(setting: tuple[str, ...]) -> tuple[float, ...]:
    """The values of a setting, in the order of its keys."""
    return tuple(float(text.partition("=")[2]) for text in setting)


def _middle(low: float, high: float) -> float:
    """The geometric mean to three digits."""
    return float(f"{math.sqrt(low * high):.3g}")


def between(keys: tuple[str, ...], kinds: Mapping[tuple[str, ...], str]) -> list[tuple[str, ...]]:
    """Settings halfway between neighbours along either axis whose classes differ."""
    classes = {place_of(setting): kind for setting, kind in kinds.items()}
    added: set[tuple[float, ...]] = set()
    for axis in (0, 1):
        lines = defaultdict(list)
        for place in classes:
            lines[place[1 - axis]].append(place)
        for line in lines.values():
            line.sort(key=lambda place, axis=axis: place[axis])
            for low, high in zip(line, line[1:], strict=False):
                if classes[low] != classes[high] and high[axis] / low[axis] > CLOSEST:
                    middle = list(low)
                    middle[axis] = _middle(low[axis], high[axis])
                    added.add(tuple(middle))
    return [tuple(f"{key}={value!r}" for key, value in zip(keys, place, strict=True)) for place in sorted(added - classes.keys())]
