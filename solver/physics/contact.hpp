// Contact between two balls, or a ball and a plane: linear and Hertz-Mindlin springs with dashpots, Coulomb friction
// and tangential history. The same models as LIGGGHTS 3.8 `gran model hooke|hertz tangential history`.
#pragma once

#include "base/vec.hpp"

namespace mappm {

enum class ContactKind { linear, hertz };

/// Material constants, internal units (rcut, PP mass, c).
struct ContactLaw {
  ContactKind kind = ContactKind::linear;
  double stiffness = 0.0;  // linear: k_n = k_t
  double young = 0.0;      // hertz, of each body; an immovable wall has the same (LIGGGHTS' convention)
  double poisson = 0.0;
  double restitution = 1.0;
  double friction = 0.0;
  /// beta = ln e / sqrt(ln^2 e + pi^2), <= 0: set by `make_contact_law`.
  double damping = 0.0;
};

ContactLaw make_contact_law(ContactKind kind, double stiffness, double young, double poisson, double restitution,
                            double friction);

/// Two balls i and j. A plane is a ball j of infinite radius and mass (inverse_* = 0).
template <int D>
struct ContactPair {
  Vec<D, double> normal;    // unit vector from j to i
  double overlap;           // > 0, rcut
  Vec<D, double> velocity;  // of i minus j at the contact point, c
  double inverse_mass_i, inverse_mass_j;
  double inverse_radius_i, inverse_radius_j;
  Vec<D, double> stretch;  // tangential spring of the step before
};

template <int D>
struct ContactResult {
  Vec<D, double> force;    // on i; on j the opposite
  Vec<D, double> stretch;  // tangential spring to keep
};

/// Force of one contact. The stretch is turned into the present tangent plane, lengthened by the tangential velocity
/// times dt, and cut where friction slides.
template <int D>
ContactResult<D> contact_force(const ContactLaw& law, const ContactPair<D>& pair, double dt);

/// Duration of a contact: linear pi sqrt(m*/k) (undamped), Hertz 2.87 (m*^2 / (R* E*^2 v))^(1/5) at impact speed v.
double contact_duration(const ContactLaw& law, double effective_mass, double effective_radius, double speed);

}  // namespace mappm
