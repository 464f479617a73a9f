// One step of the solids, shared by both engines: contacts between solids, and the kick and drift of each.
#pragma once

#include <string>
#include <vector>

#include "particles/first_fault.hpp"
#include "particles/model.hpp"
#include "particles/overlap.hpp"
#include "particles/state.hpp"
#include "physics/pseudo_particle.hpp"

namespace mappm {

/// A solid with its velocity and what acts on it in this step.
template <int D>
struct SolidInStep {
  const Solid<D>* solid = nullptr;
  const Shape<D>* shape = nullptr;
  RigidVelocity<D> velocity;
};

template <int D>
SolidInStep<D> solid_in_step(const Model<D>& model, const Solid<D>& solid) {
  const Shape<D>& shape = model.shapes[solid.shape];
  return {&solid, &shape, rigid_velocity(solid, shape)};
}

/// What acts on one solid in one step, and the contacts that it keeps.
template <int D>
struct SolidLoad {
  SolidImpulse<D> fluid;    // summed over its FPs
  SolidImpulse<D> contact;  // from other solids
  SolidImpulse<D> wall;     // from faces of walls: an impulse from outside the system
  std::vector<Contact<D>> kept;
  Overlap overlap;  // the deepest
};

/// Adds the contacts of `one` with `other` to its load. Each contact is evaluated from the smaller to the larger id,
/// so that the owners of both solids find the same bits. Where several balls of the two touch, each contact has an
/// equal share of the masses: together they lose what one would.
template <int D>
void add_contacts(const Model<D>& model, const SolidInStep<D>& one, const SolidInStep<D>& other, SolidLoad<D>& load);

/// The same with the faces of walls.
template <int D>
void add_face_contacts(const Model<D>& model, const SolidInStep<D>& one, SolidLoad<D>& load);

/// Keeps what is deeper than a bound for the first time; loads of all solids that this process owns.
template <int D>
void note_overlaps(const Model<D>& model, std::uint64_t step, const std::vector<SolidLoad<D>>& loads,
                   FirstOverlaps& first);

/// Ends the step of a solid that this process owns: body force, kick, drift. What a solid that is not free receives
/// goes to the outside; what walls and body forces give comes from it. Returns an empty text, or what left its range: a
/// solid that would move too far stays where it is, as its next owner might not be a neighbour.
template <int D>
std::string finish_step(const Model<D>& model, std::uint64_t step, Solid<D>& solid, SolidLoad<D>&& load,
                        Vec<D, Int128>& outside_impulse);

/// Constants of the step of a PP; the body force acts from step `model.relax` on.
template <int D>
ParticleStep<D> particle_step(const Model<D>& model, std::uint64_t step);

/// Notes a density, of a PP or an FP, that is out of range.
template <int D>
void note_density(const Model<D>& model, const FaultOrigin& origin, double density, FirstFault& first);

/// Notes what left its range when a PP of this velocity was moved by these sums.
template <int D>
void note_motion(RangeFault fault, const FaultOrigin& origin, const Vec<D, double>& v, const NeighbourSums<D>& sums,
                 FirstFault& first);

}  // namespace mappm
