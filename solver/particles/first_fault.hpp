// The first value that left its range, in an order that no split into processes or threads can change.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <utility>

namespace mappm {

/// Where a value left its range. Ordered by step, by what a step looks at first, and by id.
struct FaultOrigin {
  enum class What { fluid_density, frozen_density, fluid_motion, solid_motion };

  std::uint64_t step = 0;
  What what = What::fluid_density;
  std::uint64_t id = 0;     // of the PP or the solid
  std::uint64_t index = 0;  // of the FP in its solid

  auto operator<=>(const FaultOrigin&) const = default;
  /// The same order, entry by entry.
  std::array<std::uint64_t, 4> key() const { return {step, static_cast<std::uint64_t>(what), id, index}; }
};

class FirstFault {
 public:
  bool any() const { return !text_.empty(); }
  const FaultOrigin& origin() const { return origin_; }
  /// Step, particle, value and likely cause; empty where there is no fault.
  const std::string& text() const { return text_; }

  /// Whether a fault there comes before what is known.
  bool follows(const FaultOrigin& origin) const { return !any() || origin < origin_; }
  /// Keeps the earlier of two. An empty text is no fault.
  void note(const FaultOrigin& origin, std::string text) {
    if (text.empty() || !follows(origin)) return;
    origin_ = origin;
    text_ = std::move(text);
  }

 private:
  FaultOrigin origin_;
  std::string text_;
};

}  // namespace mappm
