// Everything a run needs to know that does not change: the scene made dimensionless once.
// Internal units: length rcut, mass of one PP, velocity c (the isothermal sound speed); time is then rcut / c.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "physics/contact.hpp"
#include "physics/flow_field.hpp"
#include "physics/fluid_pair.hpp"
#include "physics/kernel.hpp"
#include "physics/pair_numbers.hpp"
#include "physics/rigid_body.hpp"

namespace mappm {

/// What the scene declares, and therefore what is computed. Worked out once, printed at start, kept in run.json.
struct Terms {
  bool fluid = true;          // PPs exist
  bool transport = false;     // transport velocity
  bool extrapolated = false;  // no-slip by extrapolation; needs solids
  bool body_force = false;    // uniform
  bool force_field = false;   // on the PPs, varying in space
  bool solids = false;        // FPs exist
  bool motion = false;        // some solid is not fixed
  bool rotation = false;      // some free solid rotates
  bool contact = false;       // contact law given, and at least two solids, or one and a wall
  bool single = false;        // pairs of PPs and FPs in single precision
};

/// A face of a wall, for contact of solids with it. Its FPs are solids of their own.
template <int D>
struct WallFace {
  std::uint64_t id = 0;  // its partner id in contacts
  int axis = 0;
  double sign = 1.0;        // outward normal: +1 or -1 along the axis
  double x = 0.0;           // position quanta
  double thickness = 0.0;   // of the wall behind it, rcut
  Vec<D, double> velocity;  // c
};

/// Scene units of one internal unit, for output: value in scene units = internal value * unit.
struct UnitScale {
  double length = 1.0, velocity = 1.0, mass = 1.0;
  double time() const { return length / velocity; }
  double force() const { return mass * velocity * velocity / length; }
};

template <int D>
struct Model {
  Vec<D, double> box;  // sides, rcut
  Terms terms;
  KernelKind kernel = KernelKind::wendland_c2;
  PairLaw<D> pair;
  double rest_density = 0.0;            // rho0, PPs per rcut^D
  double background = 0.0;              // p_b
  double self_density = 0.0;            // W(0), an integer multiple of the density quantum
  double no_slip_nearest = 0.0;         // dx / 4, rcut
  double no_slip_largest = 0.0;         // bound of beta
  double shift_shear = 0.0;             // `ParticleStep::shear`
  double shift_outer = 0.0;             // `ParticleStep::outer`
  double spacing = 0.0;                 // dx, rcut
  double dt = 0.0;                      // rcut / c
  std::uint64_t relax = 0;              // body forces act from this step on
  Vec<D, double> fluid_kick{};          // body-force impulse on one PP in a step: an integer multiple of iota
  FlowField fluid_field;                // velocity (c) that it gives a PP in a step
  Vec<D, double> solid_acceleration{};  // of free SPs, c^2 / rcut
  ContactLaw contact;
  std::vector<Shape<D>> shapes;
  std::vector<WallFace<D>> faces;
  double largest_reach = 0.0;          // over shapes, rcut
  double largest_contact_reach = 0.0;  // over shapes that take part in contact, rcut
  UnitScale units;
};

/// Width of the margin of a domain in which solids are copied, rcut: a solid, and what it moves in a step, must be seen
/// wherever one of its FPs is a neighbour (the paper's L), or another solid touches it (2R). No box side may be
/// shorter.
template <int D>
double solid_margin(const Model<D>& model) {
  if (!model.terms.solids) return 0.0;
  return std::max(model.largest_reach + 1.0, 2.0 * model.largest_contact_reach) + largest_displacement;
}

/// Calls f(bool_constant<field>{}): whether the field of force acts on the PPs in this step.
template <int D, class F>
void with_force_field(const Model<D>& model, std::uint64_t step, F&& f) {
  if (model.terms.force_field && step >= model.relax)
    f(std::true_type{});
  else
    f(std::false_type{});
}

/// Calls f(Kernel{}, bool_constant<transport>{}) for the model's choice: the choice is made outside the loops.
template <int D, class F>
void with_pair_law(const Model<D>& model, F&& f) {
  const auto with_kernel = [&](auto kernel) {
    if (model.terms.transport)
      f(kernel, std::true_type{});
    else
      f(kernel, std::false_type{});
  };
  switch (model.kernel) {
    case KernelKind::wendland_c2:
      return with_kernel(WendlandC2{});
    case KernelKind::lucy:
      return with_kernel(Lucy{});
    case KernelKind::mps:
      return with_kernel(MpsWeight{});
  }
}

/// As `with_pair_law`, f(Kernel{}, bool_constant<transport>{}, numbers): with the numbers of the model's precision.
template <int D, class F>
void with_pair_numbers(const Model<D>& model, F&& f) {
  with_pair_law(model, [&](auto kernel, auto transport) {
    if (model.terms.single)
      f(kernel, transport, SinglePairs<D>(model.pair, model.rest_density));
    else
      f(kernel, transport, DoublePairs<D>(model.pair, model.rest_density));
  });
}

}  // namespace mappm
