"""Meshes of hexahedral blocks around one body in the middle of a periodic cell of side 1, centred at the origin.

Plane: four blocks between the circle and the sides, N cells along each side. Space: six between the sphere and the
faces of the cube, 2 N cells along an edge. The growth of the cells outwards is the same on all levels, and such that
those at the surface are as wide as high: the levels are similar, as an observed order needs.
"""

import itertools
import math
from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

BODY = "body"


@dataclass(frozen=True)
class Patch:
    kind: str  # of OpenFOAM
    faces: tuple[tuple[int, ...], ...]
    neighbour: str = ""  # of a cyclic one


@dataclass(frozen=True)
class BlockMesh:
    """Corners of a block: the bottom, counter-clockwise seen from the top, then the top. Cells are counted, and grow,
    along 0-1, 0-3, 0-4.
    """

    vertices: np.ndarray  # (n, 3)
    blocks: tuple[tuple[int, ...], ...]
    cells: tuple[int, int, int]  # of each block
    growth: float  # width of the last cell over the first, along 0-1 in the plane, along 0-4 in space
    arcs: tuple[tuple[int, int, tuple[float, ...]], ...]  # from, to, a point between
    patches: dict[str, Patch]
    sphere: float = 0.0  # radius of the sphere on which the faces of the body are projected; 0 for none

    @property
    def number_of_cells(self) -> int:
        return len(self.blocks) * math.prod(self.cells)


def _pair(axis: str, low: tuple, high: tuple) -> dict[str, Patch]:
    names = f"{axis}_low", f"{axis}_high"
    return {names[0]: Patch("cyclic", (low,), names[1]), names[1]: Patch("cyclic", (high,), names[0])}


def disc_mesh(radius: float, n: int) -> BlockMesh:
    """n: cells along a side, a multiple of four. Vertices: four of circle, four of square; again at z = 1."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    plane = np.vstack([corners * radius / math.sqrt(2), corners / 2])
    vertices = np.vstack([np.column_stack([plane, np.full(8, z)]) for z in (0.0, 1.0)])
    quads = [(i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4) for i in range(4)]
    blocks = tuple((*quad, *(v + 8 for v in quad)) for quad in quads)
    middles = radius * np.array([(0, -1), (1, 0), (0, 1), (-1, 0)], float)
    arcs = tuple(
        (i + 8 * top, (i + 1) % 4 + 8 * top, (*middles[i], float(top))) for top in (0, 1) for i in range(4)
    )
    sides = [(i + 4, (i + 1) % 4 + 4, (i + 1) % 4 + 12, i + 12) for i in range(4)]  # bottom, right, top, left
    patches = _pair("x", sides[3], sides[1]) | _pair("y", sides[0], sides[2])
    patches[BODY] = Patch("wall", tuple((i, (i + 1) % 4, (i + 1) % 4 + 8, i + 8) for i in range(4)))
    ends = tuple(quads) + tuple(tuple(v + 8 for v in quad) for quad in quads)
    patches["front_and_back"] = Patch("empty", ends)
    return BlockMesh(vertices, blocks, (3 * n // 4, n, 1), 2 / (math.pi * radius), arcs, patches)


def sphere_mesh(radius: float, n: int) -> BlockMesh:
    """2 n: cells along an edge of the cube; n is even. Vertices: the eight on the sphere, the eight of the cube."""
    corners = np.array(list(itertools.product((-1, 1), repeat=3)), float)
    vertices = np.vstack([corners * radius / math.sqrt(3), corners / 2])

    def corner(*signs: int) -> int:
        return sum(bit << place for bit, place in zip([s > 0 for s in signs], (2, 1, 0), strict=True))

    def face(axis: int, sign: int) -> tuple[int, ...]:
        """The four corners, counter-clockwise seen from outside."""
        u, v = (axis + 1) % 3, (axis + 2) % 3
        around = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        found = []
        for a, b in around if sign > 0 else around[::-1]:
            signs = [0, 0, 0]
            signs[axis], signs[u], signs[v] = sign, a, b
            found.append(corner(*signs))
        return tuple(found)

    faces = {(axis, sign): face(axis, sign) for axis in range(3) for sign in (-1, 1)}
    blocks = tuple((*inner, *(v + 8 for v in inner)) for inner in faces.values())
    edges = [(i, j) for i in range(8) for j in range(i) if np.abs(corners[i] - corners[j]).sum() == 2]
    middles = [(corners[i] + corners[j]) / 2 for i, j in edges]
    arcs = tuple(
        (i, j, tuple(radius * middle / np.linalg.norm(middle))) for (i, j), middle in zip(edges, middles, strict=True)
    )
    patches = {}
    for axis, name in enumerate("xyz"):
        low, high = (tuple(v + 8 for v in faces[axis, sign]) for sign in (-1, 1))
        patches |= _pair(name, low, high)
    patches[BODY] = Patch("wall", tuple(faces.values()))
    growth = max(1.0, 0.5 / (math.pi * radius / 4))
    return BlockMesh(vertices, blocks, (2 * n, 2 * n, 3 * n // 2), growth, arcs, patches, radius)


def brick_mesh(size: Sequence[float], cells: Sequence[int], walls: Set[int] = frozenset()) -> BlockMesh:
    """A block with a corner at the origin: size (D), cells (D) along each side; periodic along the axes that are not in
    `walls`. In the plane it is one cell deep, of depth 1.
    """
    in_space = len(size) == 3
    whole = np.array([*size, 1.0][:3])
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    patches = {}
    for axis, low, high in ((0, (0, 4, 7, 3), (1, 2, 6, 5)), (1, (0, 1, 5, 4), (3, 7, 6, 2)), (2, (0, 3, 2, 1), (4, 5, 6, 7))):
        if axis == 2 and not in_space:
            patches["front_and_back"] = Patch("empty", (low, high))
        elif axis in walls:
            patches |= {f"{'xyz'[axis]}_low": Patch("wall", (low,)), f"{'xyz'[axis]}_high": Patch("wall", (high,))}
        else:
            patches |= _pair("xyz"[axis], low, high)
    counts = (int(cells[0]), int(cells[1]), int(cells[2]) if in_space else 1)
    return BlockMesh(np.array(corners, float) * whole, (tuple(range(8)),), counts, 1.0, (), patches)


def box_mesh(n: int) -> BlockMesh:
    """A periodic cube of side 1 with a corner at the origin, n cells along each edge, and no body."""
    return brick_mesh((1.0, 1.0, 1.0), (n, n, n))


def mesh_of(dimension: int, radius: float, n: int) -> BlockMesh:
    return (disc_mesh if dimension == 2 else sphere_mesh)(radius, n)


def _tuple_text(values) -> str:
    return "(" + " ".join(f"{value:.15g}" for value in values) + ")"


def block_mesh_dict(mesh: BlockMesh) -> str:
    """The body of system/blockMeshDict."""
    in_space = mesh.sphere > 0
    growth = (1.0, 1.0, mesh.growth) if in_space else (mesh.growth, 1.0, 1.0)
    lines = ["scale 1;"]
    if in_space:
        lines.append(f"geometry {{ {BODY} {{ type searchableSphere; centre (0 0 0); radius {mesh.sphere:.15g}; }} }}")
    lines += ["vertices (", *map(_tuple_text, mesh.vertices), ");", "blocks ("]
    counts = f"{_tuple_text(mesh.cells)} simpleGrading {_tuple_text(growth)}"
    lines += [f"hex {_tuple_text(block)} {counts}" for block in mesh.blocks]
    lines += [");", "edges (", *(f"arc {i} {j} {_tuple_text(middle)}" for i, j, middle in mesh.arcs), ");"]
    if in_space:
        lines += ["faces (", *(f"project {_tuple_text(face)} {BODY}" for face in mesh.patches[BODY].faces), ");"]
    lines.append("boundary (")
    for name, patch in mesh.patches.items():
        neighbour = f"neighbourPatch {patch.neighbour}; " if patch.neighbour else ""
        faces = " ".join(map(_tuple_text, patch.faces))
        lines.append(f"{name} {{ type {patch.kind}; {neighbour}faces ({faces}); }}")
    return "\n".join([*lines, ");", "mergePatchPairs ();"])
