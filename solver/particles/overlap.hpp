// How deep solids in contact overlap: contacts that are too soft let them pass through each other without a sign.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>

namespace mappm {

/// Depths of an overlap in contact radii of the smaller ball: beyond the first a run is warned about, beyond the second
/// it ends.
inline constexpr double doubtful_overlap = 0.1;
inline constexpr double last_overlap = 0.5;

/// The overlap of a solid with another one or with the face of a wall.
struct Overlap {
  double depth = 0.0;       // in contact radii of the smaller ball
  std::uint64_t solid = 0;  // the smaller id of two
  double partner = 0.0;     // the larger id, or the face

  /// Faces are told from solids by their sign.
  static double of_face(std::size_t index) { return -1.0 - static_cast<double>(index); }
  static std::size_t face_of(double partner) { return static_cast<std::size_t>(-1.0 - partner); }

  /// Keeps the deeper one; of equal ones, that of the smaller ids. So the order in which they are met does not matter.
  void add(const Overlap& other) {
    if (std::tuple(-other.depth, other.solid, other.partner) < std::tuple(-depth, solid, partner)) *this = other;
  }
};

/// The deepest overlap of the first step in which one passed a bound.
struct FirstOverlap {
  double step = std::numeric_limits<double>::infinity();  // none
  Overlap overlap;
  std::string text;  // step, solids, depth and fix
};

/// Of a run, as far as one process knows.
struct FirstOverlaps {
  FirstOverlap doubtful, last;
};

}  // namespace mappm
