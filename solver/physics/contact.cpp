#include "physics/contact.hpp"

#include <cmath>

#include "base/rotation.hpp"

namespace mappm {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double sqrt_5_6 = 0.91287092917527685576;

/// E* = E / (2 (1 - nu^2)) of two equal bodies.
double effective_young(const ContactLaw& law) { return law.young / (2.0 * (1.0 - law.poisson * law.poisson)); }

/// G* = G / (2 (2 - nu)) of two equal bodies, with G = E / (2 (1 + nu)).
double effective_shear(const ContactLaw& law) { return law.young / (4.0 * (2.0 - law.poisson) * (1.0 + law.poisson)); }

/// Stiffnesses and dashpots at one overlap: F_n = k_n d - gamma_n v_n, F_t = -k_t xi - gamma_t v_t.
struct Springs {
  double normal, tangential;
  double normal_damping, tangential_damping;
};

/// k = stiffness; gamma = sqrt(4 m* k / (1 + (pi / ln e)^2)) = -2 beta sqrt(m* k).
Springs linear_springs(const ContactLaw& law, double effective_mass) {
  const double damping = -2.0 * law.damping * std::sqrt(effective_mass * law.stiffness);
  return {law.stiffness, law.stiffness, damping, damping};
}

/// S_n = 2 E* sqrt(R* d), S_t = 8 G* sqrt(R* d); k_n = 2/3 S_n, k_t = S_t; gamma = -2 sqrt(5/6) beta sqrt(S m*)
/// (Tsuji, Tanaka and Ishida 1992; Antypov and Elliott 2011).
Springs hertz_springs(const ContactLaw& law, double effective_mass, double effective_radius, double overlap) {
  const double contact_width = std::sqrt(effective_radius * overlap);
  const double normal = 2.0 * effective_young(law) * contact_width;
  const double tangential = 8.0 * effective_shear(law) * contact_width;
  const double factor = -2.0 * sqrt_5_6 * law.damping;
  return {2.0 / 3.0 * normal, tangential, factor * std::sqrt(normal * effective_mass),
          factor * std::sqrt(tangential * effective_mass)};
}

template <int D>
Vec<D, double> tangential_part(const Vec<D, double>& v, const Vec<D, double>& normal) {
  return v - dot(v, normal) * normal;
}

/// x^(1/5) for x > 0 from + - * / alone: x = m 32^k with m in [1, 32), then Newton's iteration, which from 2 has
/// settled after eight steps.
double fifth_root(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  const int k = static_cast<int>(std::floor((exponent - 1) / 5.0));
  const double m = std::ldexp(x, -5 * k);
  double root = 2.0;
  for (int i = 0; i < 8; ++i) root = 0.2 * (4.0 * root + m / (root * root * root * root));
  return std::ldexp(root, k);
}

}  // namespace

ContactLaw make_contact_law(ContactKind kind, double stiffness, double young, double poisson, double restitution,
                            double friction) {
  const double log_e = natural_log(restitution);
  return {kind, stiffness, young, poisson, restitution, friction, log_e / std::sqrt(log_e * log_e + pi * pi)};
}

/// As in LIGGGHTS, the normal force may pull just before the bodies part, and a sliding contact has no dashpot.
template <int D>
ContactResult<D> contact_force(const ContactLaw& law, const ContactPair<D>& pair, double dt) {
  const double effective_mass = 1.0 / (pair.inverse_mass_i + pair.inverse_mass_j);
  const double effective_radius = 1.0 / (pair.inverse_radius_i + pair.inverse_radius_j);
  const Springs spring = law.kind == ContactKind::linear
                             ? linear_springs(law, effective_mass)
                             : hertz_springs(law, effective_mass, effective_radius, pair.overlap);
  const double normal_force = spring.normal * pair.overlap - spring.normal_damping * dot(pair.velocity, pair.normal);

  const Vec<D, double> sliding = tangential_part(pair.velocity, pair.normal);
  ContactResult<D> result;
  result.stretch = tangential_part(pair.stretch + dt * sliding, pair.normal);
  const double elastic = spring.tangential * std::sqrt(dot(result.stretch, result.stretch));
  const double limit = law.friction * std::fabs(normal_force);
  Vec<D, double> tangential_force;
  if (elastic > limit) {
    result.stretch = (limit / elastic) * result.stretch;
    tangential_force = -(spring.tangential * result.stretch);
  } else {
    tangential_force = -(spring.tangential * result.stretch) - spring.tangential_damping * sliding;
  }
  result.force = normal_force * pair.normal + tangential_force;
  return result;
}

double contact_duration(const ContactLaw& law, double effective_mass, double effective_radius, double speed) {
  if (law.kind == ContactKind::linear) return pi * std::sqrt(effective_mass / law.stiffness);
  if (speed <= 0.0) return HUGE_VAL;
  const double young = effective_young(law);
  return 2.87 * fifth_root(effective_mass * effective_mass / (effective_radius * young * young * speed));
}

template ContactResult<2> contact_force(const ContactLaw&, const ContactPair<2>&, double);
template ContactResult<3> contact_force(const ContactLaw&, const ContactPair<3>&, double);

}  // namespace mappm
