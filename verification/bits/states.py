"""The integer states of two checkpoints, particle by particle."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np


@dataclass(frozen=True)
class State:
    """PPs: fields by name, in the order of their ids. Solids: fields by id; each a tuple of integers."""

    step: int
    ids: np.ndarray
    fluid: dict[str, np.ndarray]
    solids: dict[int, dict[str, tuple[int, ...]]]


@dataclass(frozen=True)
class Difference:
    """What is not equal in two states: names of fields by id. A particle that one lacks differs in "existence"."""

    particles: dict[int, tuple[str, ...]]
    solids: dict[int, tuple[str, ...]]

    @property
    def any(self) -> bool:
        return bool(self.particles or self.solids)


def _wide(words: np.ndarray) -> tuple[int, ...]:
    """Pairs of words (low, high) as signed integers of 128 bits."""
    values = []
    for low, high in words.reshape(-1, 2):
        value = int(low) | int(high) << 64
        values.append(value - (1 << 128) if value >> 127 else value)
    return tuple(values)


def _solid(words: np.ndarray, dimension: int) -> dict[str, tuple[int, ...]]:
    """Fields of a row of words, in the order in which the solver writes them; doubles stay as their bits."""
    angular, orientation = (1, 2) if dimension == 2 else (3, 4)
    plain = {"shape": 1, "group": 1, "motion": 1, "position": dimension}
    wide = {"momentum": dimension, "angular momentum": angular}
    at, fields = 1, {}  # the first word is the id
    for name, count in plain.items():
        fields[name] = tuple(int(word) for word in words[at : at + count])
        at += count
    for name, count in wide.items():
        fields[name] = _wide(words[at : at + 2 * count])
        at += 2 * count
    fields["orientation"] = tuple(int(word) for word in words[at : at + orientation])
    at += orientation
    fields["impulse of the fluid"] = _wide(words[at : at + 2 * dimension])
    at += 4 * dimension  # what it was at the last sample is bookkeeping, no state
    fields["contacts"] = tuple(int(word) for word in words[at:])  # their number
    if len(fields["contacts"]) != 1:
        raise ValueError(f"a solid of {len(words)} words is not of this version of the checkpoint format")
    return fields


def read_state(checkpoint: Path) -> State:
    with h5py.File(checkpoint) as file:
        dimension = int(np.ravel(file.attrs["dimension"])[0])
        ids = file["fluid/id"][:]
        order = np.argsort(ids)
        names = {"x_" + axis: axis for axis in "xyz"} | {"v_" + axis: "v" + axis for axis in "xyz"}
        fluid = {names[name]: file["fluid"][name][:][order] for name in names if name in file["fluid"]}
        contacts = file["solids/contacts"][:]
        solids, contact_at = {}, 0
        for words in file["solids/words"][:]:
            fields = _solid(words, dimension)
            (touching,) = fields["contacts"]
            rows = contacts[contact_at : contact_at + touching]
            fields["contacts"] = tuple(sorted(tuple(int(word) for word in row) for row in rows))
            contact_at += touching
            solids[int(words[0])] = fields
        return State(int(np.ravel(file.attrs["step"])[0]), ids[order], fluid, solids)


def difference(one: State, other: State) -> Difference:
    shared, at_one, at_other = np.intersect1d(one.ids, other.ids, return_indices=True)
    particles = {int(i): ("existence",) for i in np.setxor1d(one.ids, other.ids)}
    wrong = {name: one.fluid[name][at_one] != other.fluid[name][at_other] for name in one.fluid}
    for i in np.flatnonzero(np.any(list(wrong.values()), axis=0)):
        particles[int(shared[i])] = tuple(name for name in wrong if wrong[name][i])
    solids = {}
    for solid in sorted(one.solids.keys() | other.solids.keys()):
        a, b = one.solids.get(solid), other.solids.get(solid)
        names = ("existence",) if a is None or b is None else tuple(name for name in a if a[name] != b[name])
        if names:
            solids[solid] = names
    return Difference(dict(sorted(particles.items())), solids)
