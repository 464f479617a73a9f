// Makes shapes: where the FPs of a body lie, how heavy it is.
#pragma once

#include <array>
#include <vector>

#include "physics/rigid_body.hpp"

namespace mappm {

/// What a shape needs to know of the fluid. Internal units.
struct FrozenLayer {
  double spacing;          // dx
  double number_density;   // of FPs, that of the fluid
  double thickness = 1.0;  // of the shell of FPs below the surface: rcut; 0 where no fluid sees the body
};

/// A body made of balls: FPs in rings (2D) or shells (3D) at depths (k + 1/2) dx, as dense as the fluid. Points of one
/// ball that lie deeper inside another are left out. `density`: of its matter, PP masses per rcut^D. A single ball has
/// its closed-form mass and inertia; those of several are of their union (`integrate_union`; Eigen inverts in 3D).
template <int D, class Kernel>
Shape<D> make_body(std::vector<Ball<D>> balls, double density, const FrozenLayer& layer);

/// Whether a wall ends with a piece, at its lower and at its upper side along each axis.
template <int D>
struct WallEnds {
  std::array<bool, D> below{}, above{};
};

/// A piece of a plane wall, normal to `axis`: `sides` are its lengths (in the normal direction the wall's thickness).
/// FPs stand on a lattice of spacing `spacing[a]`, fitted to divide the side, half a spacing below both faces, down to
/// the layer's thickness.
/// The wall goes on beyond the piece, but for its ends: own_density and normals are those of the whole layer, and near
/// an end own_density is that of a layer which ends there.
template <int D, class Kernel>
Shape<D> make_wall_piece(int axis, const std::array<double, D>& sides, const std::array<double, D>& spacing,
                         const FrozenLayer& layer, const WallEnds<D>& ends = {});

}  // namespace mappm
