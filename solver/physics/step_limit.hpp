// Limits of the time step and the rule for the sound speed.
#pragma once

#include <algorithm>
#include <cmath>

namespace mappm {

struct StepLimits {
  double acoustic, viscous, body_force, contact;  // s; infinite where the term is absent
  double smallest() const { return std::min({acoustic, viscous, body_force, contact}); }
};

/// dt <= min(0.25 h/c, 0.125 h^2/nu, 0.25 sqrt(h/g)) with h = rcut/2 (Morris, Fox and Zhu 1997), and a twentieth of
/// the duration of the shortest contact. Above 0.7 h/c drags are wrong by 25 % without any sign of it.
inline StepLimits step_limits(double h, double c, double nu, double g, double contact_duration) {
  const double never = HUGE_VAL;
  return {1.0 * h / c, nu > 0.0 ? 0.18 * h * h / nu : never, g > 0.0 ? 0.25 * std::sqrt(h / g) : never,
          contact_duration > 0.0 ? 0.05 * contact_duration : never};
}

/// Beyond this multiple of the smallest limit a run is refused; between 1 and it, it is warned about.
inline constexpr double refused_step = 2.0;

/// c = n sqrt(max(U^2, |g| L, nu U / R)): keeps the density within 1/n^2 of rho0 (Morris, Fox and Zhu 1997).
inline double sound_speed_rule(double n, double U, double g, double L, double nu, double R) {
  return n * std::sqrt(std::max({U * U, std::fabs(g) * L, R > 0.0 ? nu * U / R : 0.0}));
}

}  // namespace mappm
