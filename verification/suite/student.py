"""Student's t: how many standard deviations hold 95 of 100 results, where the deviation itself comes from few.

The distribution for a whole number of degrees of freedom is a finite sum: Abramowitz and Stegun, Handbook of Mathematical
Functions, 1964, 26.7.3 and 26.7.4. Degrees of freedom of several sources together: Welch and Satterthwaite, Guide to the Expression
of Uncertainty in Measurement, JCGM 100:2008, G.4.
"""

import math
from collections.abc import Sequence
from functools import lru_cache

PROBABILITY = 0.95
MANY = 200  # degrees of freedom from which on the factor is that of the normal distribution, to 1 %
NORMAL = 2.0  # taken where no source is from a sample; 1.96


def inside(t: float, freedom: int) -> float:
    """Probability of a result within t standard deviations."""
    angle = math.atan(t / math.sqrt(freedom))
    cosine, odd = math.cos(angle), freedom % 2 == 1
    factor, total = (cosine, 0.0) if odd else (1.0, 0.0)
    for k in range(freedom // 2):
        total += factor
        factor *= cosine**2 * ((2 * k + 2) / (2 * k + 3) if odd else (2 * k + 1) / (2 * k + 2))
    return 2 / math.pi * (angle + math.sin(angle) * total) if odd else math.sin(angle) * total


@lru_cache
def factor_of(freedom: int) -> float:
    """At least NORMAL."""
    if freedom >= MANY:
        return NORMAL
    low, high = 0.0, 100.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if inside(middle, freedom) < PROBABILITY else (low, middle)
    return max(NORMAL, high)


def coverage_of(sources: Sequence[tuple[float, int | None]]) -> float:
    """For the sum of independent sources: (standard uncertainty, its degrees of freedom, None if it comes from no sample) each."""
    sampled = sum(u**4 / freedom for u, freedom in sources if freedom)
    if sampled == 0.0 or not all(math.isfinite(u) for u, _ in sources):
        return NORMAL
    return factor_of(max(1, int(sum(u**2 for u, _ in sources) ** 2 / sampled + 1e-9)))
