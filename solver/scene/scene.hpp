// A scene as the user declares it: typed, in the scene's own units, nothing derived. `reader` makes it from TOML,
// `build` turns it into a Model and particles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "physics/flow_field.hpp"
#include "physics/kernel.hpp"

namespace mappm {

/// A double holds every number of a step up to this.
inline constexpr std::uint64_t last_countable_step = std::uint64_t{1} << 53;

using Triple = std::array<double, 3>;  // the third entry is unused (0) in two dimensions

enum class Units { dimensionless, si };
enum class Method { classic, transport };
enum class NoSlip { plain, extrapolated };
enum class Precision { single, full };      // full: double
enum class Motion { free, fixed, moving };  // moving: with a prescribed constant velocity
enum class ContactModel { none, linear, hertz };

/// The sound speed, given as a number or by the rule c^2 = n^2 max(U^2, |g| L, 4 nu U / R) (physics/step_limit.hpp).
struct SoundSpeed {
  std::optional<double> value;  // m/s
  double factor = 0.0;          // n; by default 10 in the plane, 15 in space
  double velocity = 0.0;        // U, m/s
};

struct FluidScene {
  bool particles = true;   // false: solids alone; density, spacing and sound speed are then only the units
  double density = 0.0;    // kg/m3
  double viscosity = 0.0;  // dynamic, Pa s; in the plane all densities, masses and forces are per metre of depth
  double spacing = 0.0;    // dx, m
  double cutoff = 0.0;     // rcut, m; by default 3 dx
  SoundSpeed sound_speed;
  Method method = Method::transport;
  KernelKind kernel = KernelKind::wendland_c2;
  NoSlip no_slip = NoSlip::extrapolated;  // default follows the method
  bool transport = true;                  // default follows the method
  double background_pressure = 0.0;       // p_b in units of c^2 rho0
  double shift_rate = 0.3;                // kappa of the transport velocity
  std::optional<double> shift_shear;      // a of the share of the shift; by default it follows the viscosity
  double largest_no_slip = 1.0;           // bound of the factor beta; by default 4 in the plane, 8 in space
  Precision precision = Precision::full;  // of the pair arithmetic
  Triple velocity{};                      // at the start, m/s
  std::optional<FlowField> flow;          // added to it at the start, m/s
  struct Disorder {
    double amplitude = 0.0;  // lattice spacings along each axis, at most `largest_disorder`
    std::uint64_t seed = 0;
  };
  std::optional<Disorder> disorder;  // of the lattice at the start
};

/// A PP of the start stays in the middle half of its lattice cell.
inline constexpr double largest_disorder = 0.25;

/// One ball of a rigid body, in the frame of the body.
struct BallScene {
  Triple centre{};
  double radius = 0.0;
  double contact_radius = 0.0;
};

struct BodyScene {
  enum class Shape { ball, composite, wall } shape = Shape::ball;  // ball: a disc in 2D, a sphere in 3D
  std::string key;                                                 // "body.0", for messages
  std::vector<BallScene> balls;                                    // one for a disc or sphere, none for a wall
  double density = 0.0;                                            // kg/m3
  Motion motion = Motion::free;
  std::vector<Triple> positions;   // origins of the body's frame: listed singly, or from an array or a random packing
  std::vector<Triple> velocities;  // one per position
  std::vector<Triple> angular_velocities;  // one per position; in the plane only the last entry is used
  bool rotates = true;                     // false: the orientation is held
  // wall: a plane layer normal to `axis`, from `position` to `position + thickness`; along itself it fills the box, or
  // its extent where it has one along that axis
  int axis = 1;
  double position = 0.0;
  double thickness = 0.0;
  struct Extent {
    std::string key;  // "body.0.extent", for messages
    int axis = 0;
    double from = 0.0, to = 0.0;
  };
  std::vector<Extent> extents;  // by axis, ascending, at most one along each
};

struct ContactScene {
  bool declared = false;  // the table is there, if only to say "none"
  ContactModel model = ContactModel::none;
  double stiffness = 0.0;    // linear: k_n, N/m
  double young = 0.0;        // hertz: Young's modulus, Pa
  double poisson = 0.0;      // hertz
  double restitution = 1.0;  // e in (0, 1]
  double friction = 0.0;     // Coulomb coefficient
};

struct ForceScene {
  Triple fluid{};                  // acceleration of the PPs, m/s^2
  std::optional<FlowField> field;  // added to it, m/s^2; none if its amplitude is zero
  Triple solid{};                  // acceleration of the free SPs, m/s^2
  bool balance = false;            // solid = "balance": opposes the force on the fluid, total force zero
};

struct RunScene {
  double step = 0.0;         // s; 0: step_factor times the limit
  double step_factor = 1.0;  // fraction of the step limit
  std::uint64_t steps = 0;   // after the relaxation; 0: given as a duration
  double duration = 0.0;     // s, after the relaxation; 0: given in steps
  std::uint64_t relax = 0;   // steps before the body forces act (they are counted in the step number)
};

struct OutputScene {
  std::uint64_t sample = 100;    // steps between rows of series.csv and digests
  std::uint64_t snapshot = 0;    // steps between snapshots; 0: none but the last
  std::uint64_t checkpoint = 0;  // steps between checkpoints; 0: only on a signal
  bool solids = false;           // solids.csv: one row per SP and sample
};

struct Scene {
  std::string file;
  std::string name;
  /// The declaration as read, overrides applied and keys sorted, without the table [case]: kept in run.json.
  std::string text;
  /// What the solver understood of it, a line "key = value" each, defaults included, without what may change when a run
  /// is resumed: the table [output], and the keys `steps` and `duration` of [run]. Kept in checkpoints.
  std::string identity;
  int dimension = 2;
  Units units = Units::si;
  Triple box{};  // sides, m
  FluidScene fluid;
  std::vector<BodyScene> bodies;
  ContactScene contact;
  ForceScene force;
  RunScene run;
  OutputScene output;
};

}  // namespace mappm
