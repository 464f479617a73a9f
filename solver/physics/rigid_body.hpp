// Rigid bodies (SPs): their shape as a set of frozen particles (FPs), and their motion.
#pragma once

#include <cstdint>
#include <vector>

#include "base/fixed_point.hpp"
#include "base/rotation.hpp"
#include "base/vec.hpp"
#include "physics/range_fault.hpp"

namespace mappm {

/// One frozen particle in the frame of its body.
template <int D>
struct FrozenParticle {
  Vec<D, double> offset;     // from the body's centre of mass, in rcut
  Vec<D, double> normal;     // outward normal of the surface nearest to it
  double depth = 0.0;        // below the surface, in rcut
  double own_density = 0.0;  // what the body's own matter gives to its density: an integer multiple of the quantum
};

/// A ball (disc or sphere) of a body, for contact and for the surface.
template <int D>
struct Ball {
  Vec<D, double> offset;  // rcut
  double radius = 0.0;    // surface that the fluid sees, rcut
  double contact_radius = 0.0;
};

/// A shape shared by many SPs: geometry, mass and FPs. Lengths in rcut, mass in PP masses.
template <int D>
struct Shape {
  std::vector<Ball<D>> balls;  // empty for a piece of a wall
  std::vector<FrozenParticle<D>> frozen;
  double reach = 0.0;  // radius about the centre that holds all balls and FPs
  double mass = 0.0;
  double volume = 0.0;  // of matter that displaces fluid, rcut^D
  bool rotates = true;
  /// Inverse inertia in the body's frame: row-major, 1 entry in the plane, 9 in space.
  Vec<D == 2 ? 1 : 9, double> inverse_inertia;
};

/// A piece of a wall, not a body of balls.
template <int D>
bool is_wall_piece(const Shape<D>& shape) {
  return shape.balls.empty();
}

/// A contact between ball `own` of this SP and ball `other` of SP (or wall plane) `partner`.
template <int D>
struct Contact {
  std::uint64_t partner = 0;
  std::uint32_t own = 0, other = 0;
  Vec<D, double> stretch;  // tangential spring, seen from the smaller of the two ids, rcut
};

enum class SolidMotion : std::uint32_t { free, fixed, moving };

/// One solid (SP): the part of the state that its owner holds and its copies see.
template <int D>
struct Solid {
  std::uint64_t id = 0;
  std::uint32_t shape = 0;  // index in Model::shapes
  std::uint32_t group = 0;  // bodies of one group are one piece of matter (the pieces of a wall)
  SolidMotion motion = SolidMotion::free;
  Vec<D, double> x;                          // centre of mass, position quanta (integers)
  Vec<D, Int128> momentum{};                 // iota
  AngularVec<D, Int128> angular_momentum{};  // iota rcut
  Rotation<D> orientation;
  Vec<D, Int128> fluid_impulse{};    // received from the fluid since the start, iota
  Vec<D, Int128> sampled_impulse{};  // fluid_impulse at the last sample: bookkeeping of the series, not in the digest
  std::vector<Contact<D>> contacts;  // sorted by (partner, own, other)
};

/// Linear and angular velocity in units of c and c / rcut.
template <int D>
struct RigidVelocity {
  Vec<D, double> linear;
  AngularVec<D, double> angular;
};

template <int D>
RigidVelocity<D> rigid_velocity(const Solid<D>& solid, const Shape<D>& shape);

/// An FP in the frame of the box.
template <int D>
struct PlacedFrozen {
  Vec<D, double> x;       // position quanta, of the solid's frame; may lie outside the box
  Vec<D, double> v;       // c
  Vec<D, double> normal;  // outward, of the surface over it
  /// From the centre of mass to the surface over it, rcut, before the position is rounded. There the traction of the
  /// fluid acts; at the FP, deeper by half a spacing and more, its torque would be too small in first order of the
  /// spacing.
  Vec<D, double> lever;
};

/// length: of a position quantum, per axis (PairLaw::length).
template <int D>
PlacedFrozen<D> place(const Solid<D>& solid, const RigidVelocity<D>& velocity, const FrozenParticle<D>& frozen,
                      const Vec<D, double>& length);

/// Impulses that act on a solid in one step: exact integers.
template <int D>
struct SolidImpulse {
  Vec<D, Int128> linear{};          // iota
  AngularVec<D, Int128> angular{};  // iota rcut
};

/// Torque impulse of an impulse (iota) that acts on an FP or contact point at `lever` (rcut) from the centre.
template <int D>
AngularVec<D, Int128> torque_impulse(const Vec<D, double>& lever, const Vec<D, double>& impulse);

/// What the torque of the pair law lacks, over `dt`: iota rcut. The law hands on the momentum flux mu grad u, and the
/// stress of a fluid is mu (grad u + grad u^T). On a rigid body with no slip the second part gives no force, and the
/// couple mu times the integral of x cross (n cross omega) over its surface, which is -2 mu V omega in plane and space,
/// whatever the flow. Without it a body would be spun up by a fluid that turns with it.
template <int D>
AngularVec<D, Int128> stress_couple(double viscosity, const Shape<D>& shape, const AngularVec<D, double>& omega,
                                    double dt);

/// Kick and drift of one solid over `dt` (internal units): momentum first, then position by the new velocity and
/// orientation by the angular velocity at the middle of the step, which keeps the energy of free rotation. A fixed
/// solid keeps all, a moving one drifts with its constant momentum. Positions are wrapped into the box. A solid any
/// point of which would move more than `largest_displacement` is left as it was: RangeFault::displacement.
template <int D>
RangeFault advance(Solid<D>& solid, const Shape<D>& shape, const SolidImpulse<D>& impulse, double dt,
                   const Vec<D, double>& length);

}  // namespace mappm
