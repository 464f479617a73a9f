"""The drag on one sphere alone, from that on spheres in periodic cells that are ever wider.

All drags are F / (6 pi mu R U), U the superficial velocity, Reynolds numbers on the diameter.
"""

from dataclasses import dataclass

import numpy as np

# 1 / drag = 1 - h(p) in Stokes flow through a simple cubic array, p the cube root of the solids fraction; powers of p and
# their factors in h. Hasimoto, J. Fluid Mech. 5, 1959, 317-328; Sangani and Acrivos, Int. J. Multiphase Flow 8, 1982, 343-360.
STOKES = {1: 1.7601, 3: -1.0, 6: 1.5593, 8: -3.9799, 10: 3.0734}


@dataclass(frozen=True)
class Isolated:
    """1 / drag = a - b h(p); alone, p = 0, the drag is 1 / a. In Stokes flow a = b = 1."""

    value: float
    uncertainty: float  # standard, of `value`
    a: float
    b: float

    def drag(self, fraction: np.ndarray) -> np.ndarray:
        return 1 / (self.a - self.b * hindrance(fraction))


def hindrance(fraction: np.ndarray) -> np.ndarray:
    """h, for solids fractions up to 0.22."""
    p = np.cbrt(fraction)
    return sum(factor * p**power for power, factor in STOKES.items())


def _fitted(h: np.ndarray, inverse: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(a, b) by weighted least squares, and their covariance."""
    weighted = np.column_stack([np.ones_like(h), -h]) / error[:, None]
    coefficients, *_ = np.linalg.lstsq(weighted, inverse / error, rcond=None)
    return coefficients, np.linalg.inv(weighted.T @ weighted)


def isolated(fraction: list[float], drag: list[float], uncertainty: list[float]) -> Isolated:
    """From at least three solids fractions; `uncertainty`, standard, of the drags.

    With inertia the approach to p = 0 has no known form, and that of Stokes flow is taken with free factors: so the change
    of the result without the densest of the cells counts as an uncertainty.
    """
    if len(fraction) < 3:
        raise ValueError(f"{len(fraction)} solids fractions; a fit of two coefficients needs three to show its error")
    order = np.argsort(fraction)
    h = hindrance(np.array(fraction, dtype=float)[order])
    inverse = 1 / np.array(drag, dtype=float)[order]
    error = np.array(uncertainty, dtype=float)[order] * inverse**2
    (a, b), covariance = _fitted(h, inverse, error)
    (without, _), _ = _fitted(h[:-1], inverse[:-1], error[:-1])
    return Isolated(float(1 / a), float(np.hypot(np.sqrt(covariance[0, 0]), a - without) / a**2), float(a), float(b))


def correlations(reynolds: float) -> dict[str, float]:
    """Published fits to measurements of one sphere alone, for Reynolds numbers from 0 to 200, by their authors."""
    clift = 0.1315 * reynolds ** (0.82 - 0.05 * np.log10(reynolds)) if reynolds <= 20 else 0.1935 * reynolds**0.6305
    return {
        "Schiller and Naumann 1933": 1 + 0.15 * reynolds**0.687,
        "Abraham 1970": (1 + np.sqrt(reynolds) / 9.06) ** 2,
        "Clift, Grace and Weber 1978": float(1 + clift),
        "Cheng 2009": (1 + 0.27 * reynolds) ** 0.43 + 0.47 / 24 * reynolds * (1 - np.exp(-0.04 * reynolds**0.38)),
    }
