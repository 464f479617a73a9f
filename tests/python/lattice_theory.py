"""Linear theory of one step on a lattice of PPs, from the formulas of the method alone.

A wave displaces the PP at x by d exp(i k.x) and gives it the velocity v exp(i k.x). To first order in both, a partner
at x - r has exp(-i k.r) times as much, and the laws of the solver become sums over the partners of one PP. Lengths in
rcut, velocities in c; h = 1/2; a PP has the volume V of a cell of the lattice.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np

# By q = r / rcut, up to a factor: W, -W'/r (of that same W), G and G'/r; G has a factor of its own.
KERNELS = {
    "wendland-c2": (
        lambda q: (1 - q) ** 4 * (1 + 4 * q),
        lambda q: 20 * (1 - q) ** 3,
        lambda q: (1 - q) ** 3,
        lambda q: -3 * (1 - q) ** 2 / q,
    ),
    "lucy": (
        lambda q: (1 - q) ** 3 * (1 + 3 * q),
        lambda q: 12 * (1 - q) ** 2,
        lambda q: (1 - q) ** 2,
        lambda q: -2 * (1 - q) / q,
    ),
}
SIDE_2, SIDE_3 = (2 / 3**0.5) ** 0.5, 4 ** (1 / 3) / 2  # with which a cell has the volume 1
BASES = {
    "square": np.eye(2),
    "hexagonal": SIDE_2 * np.array([[1, 0], [0.5, 0.75**0.5]]),
    "cubic": np.eye(3),
    "face-centred": SIDE_3 * (1 - np.eye(3)),
}


@dataclass(frozen=True)
class Law:
    """What a step depends on beside the lattice."""

    step: float  # c dt / h
    viscosity: float = 0.0  # nu / (c h)
    shift: float = 0.0  # kappa; with its whole share
    background: float = 0.0  # pressure, c^2 rho_0

    def with_step(self, step: float) -> "Law":
        return replace(self, step=step)


@dataclass(frozen=True)
class Lattice:
    """One of BASES with V = dx^D, and what the kernel makes of the partners of a node."""

    kind: str
    reach: float  # rcut / dx
    kernel: str

    @property
    def dimension(self) -> int:
        return len(BASES[self.kind])

    @cached_property
    def scales(self) -> tuple[float, float]:
        """Factors of V W and V G: sum V W = 1, sum V r^2 G = D."""
        weight, _, gradient, _ = KERNELS[self.kernel]
        q = np.linalg.norm(self.partners, axis=1)
        return 1 / (weight(0.0) + weight(q).sum()), self.dimension / (q**2 * gradient(q)).sum()

    @cached_property
    def partners(self) -> np.ndarray:
        most = int(2 * self.reach) + 2
        nodes = np.array(list(product(range(-most, most + 1), repeat=self.dimension))) @ BASES[self.kind] / self.reach
        q = np.linalg.norm(nodes, axis=1)
        return nodes[(q > 1e-9) & (q < 1)]

    def sums(self, k: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of wave vectors k (n, D): accelerations by a displacement, through pressure and unevenness, (n, D, D);
        friction (n)."""
        _, slope, gradient, gradient_slope = KERNELS[self.kernel]
        r = self.partners
        q = np.linalg.norm(r, axis=1)
        of_weight, of_gradient = self.scales
        minus_w, g, g_slope = of_weight * slope(q), of_gradient * gradient(q), of_gradient * gradient_slope(q)
        partner = np.exp(-1j * k @ r.T)
        density = -((1 - partner) * minus_w) @ r  # relative change: W changes by W'/r r.(d_i - d_j)
        push = ((1 + partner) * g) @ r  # sum V G r (rho_i + rho_j) / rho_0
        pressure = push[:, :, None] * density[:, None, :]
        friction = 2 * ((1 - partner) * g).sum(axis=1)
        # change of sum V G r itself
        uneven = np.einsum("kn,ni,nj->kij", (1 - partner) * g_slope, r, r)
        uneven += 0.5 * friction[:, None, None] * np.eye(self.dimension)
        for value in (pressure, friction, uneven):
            assert np.abs(value.imag).max() < 1e-9  # a lattice looks the same from both sides
        return pressure.real, uneven.real, friction.real

    def step_maps(self, k: np.ndarray, law: Law) -> np.ndarray:
        """(d, v) after a step from (d, v) before it, (n, 2 D, 2 D).

        Density at x_n, forces with it and with v_n, kick, drift with the new velocity; the shift by what stood at x_n.
        """
        return assembled(self.sums(k), law)

    def wave_map(self, k: np.ndarray, axis: int, law: Law) -> np.ndarray:
        """The 2 x 2 map of displacement and velocity along one axis; k lies along an axis, so others take no part."""
        whole, n = self.step_maps(k[None], law)[0], self.dimension
        own = [axis, n + axis]
        others = [i for i in range(2 * n) if i not in own]
        assert np.abs(whole[np.ix_(others, own)]).max() < 1e-9
        return whole[np.ix_(own, own)]


def assembled(sums: tuple[np.ndarray, np.ndarray, np.ndarray], law: Law) -> np.ndarray:
    pressure, uneven, friction = sums
    h, one = 0.5, np.broadcast_to(np.eye(pressure.shape[1]), pressure.shape)
    dt, nu = law.step * h, law.viscosity * h
    # The background pressure acts by unevenness, too, and by V^2 of the compressed PPs.
    force = pressure + 2 * law.background * (uneven - pressure)
    new_v = np.concatenate([dt * force, one * (1 - dt * nu * friction[:, None, None])], axis=2)
    moved = np.concatenate([one + dt * law.shift * h * (uneven - pressure), 0 * one], axis=2)
    return np.concatenate([moved + dt * new_v, new_v], axis=1)


def growth(one_step: np.ndarray) -> float:
    """Largest factor of a wave in a step."""
    return np.abs(np.linalg.eigvals(one_step)).max()


def flips(one_steps: np.ndarray) -> bool:
    """Whether any of these waves grows with a sign that changes in each step."""
    values = np.linalg.eigvals(one_steps)
    return bool(((np.abs(values.imag) < 1e-9) & (values.real < -1 - 1e-9)).any())


def first_instability(lattices: list[Lattice], law: Law, numbers: int) -> float:
    """c dt / h from which on a wave flips: of all directions, so many wave numbers along each axis of the zone."""
    shortest = 1.3 * np.pi  # beyond which, along an axis, waves repeat; 1 / dx
    sums = []
    for lattice in lattices:
        axis = np.linspace(0, shortest * lattice.reach, numbers)
        k = np.array([k for k in product(axis, repeat=lattice.dimension) if any(k)])
        sums.append(lattice.sums(k))
    low, high = 0.0, 4.0
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        grows = any(flips(assembled(one, law.with_step(middle))) for one in sums)
        low, high = (low, middle) if grows else (middle, high)
    return low
