#include "parallel/residents.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "physics/fluid_pair.hpp"

namespace mappm {

template <int D>
Region<D> widened(const Model<D>& model, Region<D> region, double margin) {
  for (int axis = 0; axis < D; ++axis) {
    const double quanta = std::ceil(margin / model.pair.length[axis]);
    region.low[axis] -= quanta;
    region.high[axis] += quanta;
  }
  return region;
}

namespace {

template <int D>
Vec<D, double> place_of(const FluidParticles<D>& fluid, std::size_t i) {
  Vec<D, double> x;
  for (int axis = 0; axis < D; ++axis) x[axis] = fluid.x(axis)[i];
  return x;
}

}  // namespace

template <int D>
Residents<D>::Residents(const Model<D>& model, const Region<D>& region)
    : model_(model),
      region_(region),
      may_own_(widened(model, region, 0.5 * skin)),
      deep_(widened(model, region, -0.5 * skin)),
      noticed_(widened(model, region, 1.0 + 0.5 * skin)),
      sending_(widened(model, region, -1.0 - 1.5 * skin)) {}

template <int D>
void Residents<D>::settle(const FluidParticles<D>& fluid) {
  sent_.clear();
  places_.clear();
  near_outside_.clear();
  owned_.clear();
  std::vector<std::uint32_t> ghosts;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    const Vec<D, double> x = place_of(fluid, i);
    if (sending_.contains(x)) continue;
    const auto place = static_cast<std::uint32_t>(i);
    if (deep_.contains(x)) {
      sent_.push_back(place);
    } else if (may_own_.contains(x)) {
      const bool owned = region_.contains(x);
      places_.push_back(place);
      owned_.push_back(owned ? 1 : 0);
      if (!owned) near_outside_.push_back(place);
    } else {
      ghosts.push_back(place);
    }
  }
  near_ = places_.size();
  places_.insert(places_.end(), ghosts.begin(), ghosts.end());
  up_to_date_.assign(places_.size(), 0);
  table_.assign(std::bit_ceil(2 * places_.size() + 1), none);
  for (std::uint32_t n = 0; n < places_.size(); ++n) {
    std::uint32_t* slot = slot_of(fluid.id[places_[n]]);
    while (*slot != none) slot = next(slot);
    *slot = n;
  }
  travelled_ = farthest_ = 0.0;
  staying_ = true;
}

/// Where the search for an id begins; several images of one PP follow each other.
template <int D>
std::uint32_t* Residents<D>::slot_of(std::uint64_t id) {
  return &table_[static_cast<std::size_t>(id * 0x9e3779b97f4a7c15u >> 32) & (table_.size() - 1)];
}

template <int D>
std::uint32_t* Residents<D>::next(std::uint32_t* slot) {
  return ++slot == table_.data() + table_.size() ? table_.data() : slot;
}

template <int D>
bool Residents<D>::refresh(FluidParticles<D>& fluid, std::span<BufferReader> readers) {
  std::copy(owned_.begin(), owned_.end(), up_to_date_.begin());
  std::fill(up_to_date_.begin() + static_cast<std::ptrdiff_t>(near_), up_to_date_.end(), 0);
  for (BufferReader& reader : readers)
    if (!refresh(fluid, reader)) return false;
  if (!lasts()) return false;
  travelled_ += farthest_;
  farthest_ = 0.0;
  for (std::size_t n = 0; n < places_.size(); ++n)
    if (up_to_date_[n] == 0 && noticed_.contains(place_of(fluid, places_[n]))) return false;
  for (std::size_t n = 0; n < near_; ++n) owned_[n] = region_.contains(place_of(fluid, places_[n])) ? 1 : 0;
  return true;
}

template <int D>
bool Residents<D>::refresh(FluidParticles<D>& fluid, BufferReader& reader) {
  const auto count = reader.get<std::uint64_t>();
  const std::byte* const ids = reader.skip<std::uint64_t>(count);
  const std::byte* const fields = reader.skip<double>(count * FluidParticles<D>::field_count);
  const auto value = [&](std::size_t field, std::size_t k) {
    double result;
    std::memcpy(&result, fields + (field * count + k) * sizeof result, sizeof result);
    return result;
  };
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t id;
    std::memcpy(&id, ids + k * sizeof id, sizeof id);
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = value(static_cast<std::size_t>(axis), k);
    std::uint32_t* slot = slot_of(id);
    double square = 0.0;
    for (; *slot != none; slot = next(slot)) {
      const std::uint32_t place = places_[*slot];
      if (fluid.id[place] != id) continue;
      const Vec<D, double> moved = separation(model_.pair, x - place_of(fluid, place));
      square = dot(moved, moved);
      if (square <= skin * skin) break;  // another image is a box away
    }
    if (*slot == none) {
      if (noticed_.contains(x)) return false;
      continue;
    }
    farthest_ = std::max(farthest_, std::sqrt(square));
    for (std::size_t f = 0; f < fluid.field.size(); ++f) fluid.field[f][places_[*slot]] = value(f, k);
    up_to_date_[*slot] = 1;
  }
  return true;
}

template <int D>
void Residents<D>::leave(FluidParticles<D>& fluid) {
  if (!staying_) return;
  staying_ = false;
  std::vector<std::uint32_t> gone;  // in rising order
  for (std::size_t n = 0; n < places_.size(); ++n)
    if (n >= near_ || owned_[n] == 0) gone.push_back(places_[n]);
  std::sort(gone.begin(), gone.end());
  std::size_t kept = 0, from = 0;
  const auto keep_until = [&](std::size_t end) {
    const auto move = [&](auto& values) {
      std::copy(values.begin() + static_cast<std::ptrdiff_t>(from), values.begin() + static_cast<std::ptrdiff_t>(end),
                values.begin() + static_cast<std::ptrdiff_t>(kept));
    };
    move(fluid.id);
    for (auto& values : fluid.field) move(values);
    kept += end - from;
  };
  for (const std::uint32_t place : gone) {
    keep_until(place);
    from = place + 1;
  }
  keep_until(fluid.size());
  fluid.resize(kept);
}

#define MAPPM_INSTANTIATE(D)                                                    \
  template class Residents<D>;                                                  \
  template Region<D> widened<D>(const Model<D>&, Region<D>, double);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
