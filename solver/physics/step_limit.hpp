// Limits of the time step and the rule for the sound speed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace mappm {

/// One reason why a step can be too long. In one unit of time; infinite where the reason is absent.
struct StepLimit {
  std::string_view of;         // the reason: "sound", "viscosity", "added mass", "force" or "contact"
  double usual = HUGE_VAL;     // the step at run.step_factor = 1
  double doubtful = HUGE_VAL;  // beyond it a run is warned about
  double last = HUGE_VAL;      // beyond it a run is refused: a wave grows, or a motion is not resolved
};

struct StepLimits {
  StepLimit waves, light_solids, force, contact;

  std::array<StepLimit, 4> all() const { return {waves, light_solids, force, contact}; }
  /// The one that rules: the shortest step at run.step_factor = 1.
  StepLimit ruling() const {
    const auto limits = all();
    return *std::min_element(limits.begin(), limits.end(),
                             [](const StepLimit& a, const StepLimit& b) { return a.usual < b.usual; });
  }
  /// The one that a growing step passes first, doubtful or last.
  template <class Border>
  StepLimit first(Border border) const {
    const auto limits = all();
    return *std::min_element(limits.begin(), limits.end(),
                             [&](const StepLimit& a, const StepLimit& b) { return a.*border < b.*border; });
  }
};

/// Share of the step of the first instability at which steps are neither warned about nor, at run.step_factor = 1,
/// longer: a PP may come nearer to others, or to a wall, than on the lattices for which the instability is known.
inline constexpr double margin_to_instability = 0.8;

/// Waves of sound and viscosity: dt = h / c at run.step_factor = 1, or less where the first instability, in h / c
/// (`first_instability`), is near. inviscid: where it would be without viscosity.
inline StepLimit wave_limit(double h, double c, double first, double inviscid) {
  const double usual = std::min(1.0, margin_to_instability * first);
  const bool by_shift = margin_to_instability * inviscid < 1.0;
  return {usual == 1.0 ? "sound"
          : by_shift   ? "shift"
                       : "viscosity",
          usual * h / c, margin_to_instability * first * h / c, first * h / c};
}

/// A free body as the fluid beside it drags it. In one system of units.
struct DraggedBody {
  int dimension = 2;
  double mass = 0.0, surface = 0.0;  // M, A
  double slowness = HUGE_VAL;  // I / R^2 with its moment of inertia I and radius R; infinite where it does not turn
};

/// The fluid drags along a body that is lighter than what it drags: beyond dt = 2 M / Gamma it is thrown to and fro,
/// farther in each step, and beyond 2 I / (s R^2 Gamma_mu) it is turned so. Gamma = A (a mu / h + b rho c) is the
/// friction of the FPs on PPs beside it, Gamma_mu its part by viscosity, s = 1 in the plane and 2 / 3 in space the
/// share of the surface that moves as it turns. a and b are measured, on free discs and spheres of 1 to 0.001 times the
/// density of the fluid at rest.
inline StepLimit light_solid_limit(const DraggedBody& body, double h, double c, double mu, double rho) {
  const double a = body.dimension == 2 ? 3.1 : 3.4, share = body.dimension == 2 ? 1.0 : 2.0 / 3.0;
  constexpr double b = 0.083;
  const double viscous = body.surface * a * mu / h;
  const double last = std::min(2.0 * body.mass / (viscous + body.surface * b * rho * c),
                               viscous > 0.0 ? 2.0 * body.slowness / (share * viscous) : HUGE_VAL);
  return {"added mass", 0.7 * last, margin_to_instability * last, last};
}

/// 0.25 sqrt(h / g) (Morris, Fox and Zhu 1997).
inline StepLimit force_limit(double h, double g) {
  if (!(g > 0.0)) return {"force"};
  const double usual = 0.25 * std::sqrt(h / g);
  return {"force", usual, usual, 2.0 * usual};
}

/// A twentieth of the duration of the shortest contact.
inline StepLimit contact_limit(double duration) {
  if (!(duration > 0.0)) return {"contact"};
  return {"contact", 0.05 * duration, 0.05 * duration, 0.1 * duration};
}

/// c = n sqrt(max(U^2, |g| L, 4 nu U / R)): keeps the density within 1/n^2 of rho0 (Morris, Fox and Zhu 1997). In
/// viscous flow, where viscosity limits the step, a faster sound costs nothing.
inline double sound_speed_rule(double n, double U, double g, double L, double nu, double R) {
  return n * std::sqrt(std::max({U * U, std::fabs(g) * L, R > 0.0 ? 4.0 * nu * U / R : 0.0}));
}

}  // namespace mappm
