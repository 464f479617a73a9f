"""Drag of one sphere in a wide fluid: correlations of experiments, C_D over the Reynolds number on the diameter."""

import math
from collections.abc import Callable

from reference.published.cell import cell_of, refuse_outside
from reference.published.value import Published


def schiller_naumann(re: float) -> float:
    """Z. Ver. Dtsch. Ing. 77, 1933, 318-320; to 800."""
    return 24 / re * (1 + 0.15 * re**0.687)


def clift_grace_weber(re: float) -> float:
    """Bubbles, Drops, and Particles, 1978, table 5.2; two of its pieces, 0.01 to 260."""
    if re <= 20:
        return 24 / re * (1 + 0.1315 * re ** (0.82 - 0.05 * math.log10(re)))
    return 24 / re * (1 + 0.1935 * re**0.6305)


def turton_levenspiel(re: float) -> float:
    """Powder Technol. 47, 1986, 83-86; to 2e5."""
    return 24 / re * (1 + 0.173 * re**0.657) + 0.413 / (1 + 16300 * re**-1.09)


def haider_levenspiel(re: float) -> float:
    """Powder Technol. 58, 1989, 63-70; to 2e5."""
    return 24 / re * (1 + 0.1806 * re**0.6459) + 0.4251 / (1 + 6880.95 / re)


def brown_lawler(re: float) -> float:
    """J. Environ. Eng. 129, 2003, 222-231; to 2e5."""
    return 24 / re * (1 + 0.15 * re**0.681) + 0.407 / (1 + 8710 / re)


def abraham(re: float) -> float:
    """Phys. Fluids 13, 1970, 2194-2195; to 5000."""
    return 24 / 9.06**2 * (1 + 9.06 / math.sqrt(re)) ** 2


CORRELATIONS: dict[str, Callable[[float], float]] = {
    "Schiller and Naumann 1933": schiller_naumann,
    "Abraham 1970": abraham,
    "Clift, Grace and Weber 1978": clift_grace_weber,
    "Turton and Levenspiel 1986": turton_levenspiel,
    "Haider and Levenspiel 1989": haider_levenspiel,
    "Brown and Lawler 2003": brown_lawler,
}


def spread(re: float) -> dict[str, float]:
    """F / (6 pi mu R U) = C_D Re / 24 of each correlation."""
    refuse_outside("Re", re, 0.01, 260.0, "the correlations for one sphere")
    return {name: law(re) * re / 24 for name, law in CORRELATIONS.items()}


def isolated_sphere(scene: dict) -> Published:
    """Middle of the correlations; the uncertainty is half the distance between the outermost."""
    values = spread(cell_of(scene, 3).reynolds).values()
    low, high = min(values), max(values)
    return Published(0.5 * (low + high), 0.5 * (high - low), "correlations for one sphere: " + ", ".join(CORRELATIONS))
