// Linear stability of the step: which waves on a lattice of PPs grow, and from which step on.
//
// Displacements x and velocities v of a wave along a symmetric direction of the lattice obey, in one step,
//   v' = (1 - dt nu g) v - dt c^2 p x
//   x' = (1 + dt kappa c h (H + p)) x + dt v'
// with the sums over the neighbours of a PP, normalised as in the pair law (k wave vector, e its direction, t that of
// the displacement, along e or across it; p is 0 across)
//   p = (sum V G (e.r) sin k.r) (sum V (-W'/r) (e.r) sin k.r),  g = 2 sum V G (1 - cos k.r),
//   H = sum V (G + G' (t.r)^2 / r) (1 - cos k.r).
// The step is too long where a wave grows with a sign that changes in each step. Other growth is that of an uneven
// lattice on its way to an even one, and knows no step.
#pragma once

#include <vector>

#include "physics/kernel.hpp"

namespace mappm {

/// The sums of one wave; length in spacings dx, of which a PP has the volume dx^D.
struct LatticeWave {
  double pressure = 0.0;  // p, dx^-2
  double shift = 0.0;     // H, dx^-2
  double friction = 0.0;  // g, dx^-2
};

/// Waves of all lengths along the symmetric directions of two lattices: the square one and the hexagonal one in the
/// plane, the simple and the face-centred cubic one in space. `reach`: rcut / dx.
template <int D>
std::vector<LatticeWave> lattice_waves(KernelKind kernel, double reach);

/// Whether a wave does not grow with a sign that changes in each step. `step` in dx / c, `viscosity` nu in c dx,
/// `shift_rate` kappa h in dx.
bool is_stable(const LatticeWave& wave, double step, double viscosity, double shift_rate);

/// By how much the friction of a PP at a wall may exceed that of one in the fluid: by the factors beta, which are at
/// most `largest_no_slip`, of the FPs beyond. The PP touches one plane wall or sits in the corner of `walls` of them,
/// which stand across one another.
template <int D>
double wall_friction(KernelKind kernel, double reach, double largest_no_slip, int walls);

/// c dt / h at which the first wave begins to grow, cut to two decimals. `viscosity`: nu / (c h).
template <int D>
double first_instability(KernelKind kernel, double reach, double viscosity, double shift_rate);

}  // namespace mappm
