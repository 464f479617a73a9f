#include "parallel/residents.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <numeric>

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

template <int D>
Residents<D>::Residents(const Model<D>& model, const Region<D>& region, const std::vector<NeededRegion<D>>& needed)
    : model_(model),
      region_(region),
      may_come_to_own_(widened(model, region, 0.5 * skin)),
      deep_(widened(model, region, -0.5 * skin)),
      noticed_(widened(model, region, 1.0 + 0.5 * skin)),
      needless_(widened(model, region, -1.0 - 1.5 * skin)),
      needed_(needed),
      candidates_(needed.size()) {
  for (const NeededRegion<D>& one : needed) may_enter_.push_back(widened(model, one.region, 0.5 * skin));
}

template <int D>
void Residents<D>::settle(const FluidParticles<D>& fluid, bool single_step) {
  for (auto& candidates : candidates_) candidates.clear();
  foreign_.clear();
  near_outside_.clear();
  owned_.clear();
  std::vector<std::uint32_t> ghosts;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    const Vec<D, double> x = fluid.position(i);
    if (needless_.contains(x)) continue;
    const auto particle = static_cast<std::uint32_t>(i);
    if (!may_come_to_own_.contains(x)) {
      ghosts.push_back(particle);
      continue;
    }
    std::uint32_t near = none;
    if (!deep_.contains(x)) {
      near = static_cast<std::uint32_t>(foreign_.size());
      const bool owned = region_.contains(x);
      foreign_.push_back(particle);
      owned_.push_back(owned ? 1 : 0);
      if (!owned) near_outside_.push_back(particle);
    }
    for (std::size_t n = 0; n < candidates_.size(); ++n)
      if (may_enter_[n].contains(x)) candidates_[n].push_back({particle, near, none});
  }
  near_ = foreign_.size();
  foreign_.insert(foreign_.end(), ghosts.begin(), ghosts.end());
  steps_ = 1;
  travelled_ = single_step ? skin : 0.0;
  farthest_ = 0.0;
  end_ = never;
  ending_ = false;
  staying_ = true;
  up_to_date_.assign(foreign_.size(), 0);
  table_.assign(std::bit_ceil(2 * foreign_.size() + 1), none);
  twins_.resize(foreign_.size());
  std::iota(twins_.begin(), twins_.end(), 0u);
  for (std::uint32_t n = 0; n < foreign_.size(); ++n) {
    const std::uint64_t id = fluid.id[foreign_[n]];
    const std::uint32_t* probe = probe_of(id);
    for (; *probe != none; probe = next(probe))
      if (twins_[n] == n && fluid.id[foreign_[*probe]] == id) std::swap(twins_[n], twins_[*probe]);
    table_[static_cast<std::size_t>(probe - table_.data())] = n;
  }
  for (std::size_t n = 0; n < needed_.size(); ++n) {
    if (!needed_[n].image_shift) continue;
    for (Candidate& candidate : candidates_[n]) {
      const std::uint64_t id = fluid.id[candidate.particle];
      const Vec<D, double> image = fluid.position(candidate.particle) + *needed_[n].image_shift;
      const auto is_image = [&](std::uint32_t k) {
        return fluid.id[foreign_[k]] == id && fluid.position(foreign_[k]) == image;
      };
      const std::uint32_t* probe = probe_of(id);
      while (*probe != none && !is_image(*probe)) probe = next(probe);
      candidate.image = *probe;
    }
  }
  states_.clear(foreign_.size());
  densities_.clear(foreign_.size());
}

template <int D>
std::uint64_t Residents<D>::plan(std::uint64_t step) {
  if (!staying_ || travelled_ >= skin) return never;  // those who make lists in every step would have all do so
  constexpr double doubt = 0.1;                       // steps by which the others should not be surprised
  const double left = (allowance - used()) * steps_ / used();
  if (left < 0.0)
    end_ = step;
  else if (2.0 * used() > allowance)
    end_ = std::min(end_, step + 1 + static_cast<std::uint64_t>(std::max(0.0, left - doubt)));
  ending_ = end_ <= step;
  return end_;
}

template <int D>
void Residents<D>::adopt_plan(std::uint64_t step, std::uint64_t plan) {
  if (!lasts() || plan >= end_) return;
  const double steps = steps_ + static_cast<double>(plan - step);  // of the stay by then
  if (steps < worthwhile || 2.0 * used() * steps < allowance * steps_) return;
  end_ = plan;
  ending_ = end_ <= step;
}

template <int D>
void Residents<D>::select(const FluidParticles<D>& fluid, std::size_t n, std::vector<std::uint32_t>& chosen) const {
  for (const Candidate& candidate : candidates_[n])
    if (is_needed(fluid, n, candidate)) chosen.push_back(candidate.particle);
}

/// Where the search for an id begins; several images of one PP follow each other.
template <int D>
const std::uint32_t* Residents<D>::probe_of(std::uint64_t id) const {
  return &table_[static_cast<std::size_t>(id * 0x9e3779b97f4a7c15u >> 32) & (table_.size() - 1)];
}

template <int D>
const std::uint32_t* Residents<D>::next(const std::uint32_t* probe) const {
  return ++probe == table_.data() + table_.size() ? table_.data() : probe;
}

template <int D>
std::vector<std::uint32_t> Residents<D>::others() const {
  std::vector<std::uint32_t> others(foreign_.begin() + static_cast<std::ptrdiff_t>(near_), foreign_.end());
  for (std::size_t n = 0; n < near_; ++n)
    if (owned_[n] == 0) others.push_back(foreign_[n]);
  return others;
}

template <int D>
bool Residents<D>::refresh(FluidParticles<D>& fluid, std::span<BufferReader> readers) {
  std::copy(owned_.begin(), owned_.end(), up_to_date_.begin());
  std::fill(up_to_date_.begin() + static_cast<std::ptrdiff_t>(near_), up_to_date_.end(), 0);
  for (std::size_t n = 0; n < needed_.size(); ++n)
    if (needed_[n].image_shift) refresh_images(fluid, n);
  states_.of_messages.resize(readers.size());
  for (std::size_t n = 0; n < readers.size(); ++n)
    if (!refresh(fluid, readers[n], states_.of_messages[n])) return false;
  if (!lasts()) return false;
  travelled_ += farthest_;
  farthest_ = 0.0;
  for (std::size_t n = 0; n < foreign_.size(); ++n)
    if (up_to_date_[n] == 0 && noticed_.contains(fluid.position(foreign_[n]))) return false;
  ++steps_;
  for (std::size_t n = 0; n < near_; ++n) owned_[n] = region_.contains(fluid.position(foreign_[n])) ? 1 : 0;
  return true;
}

template <int D>
void Residents<D>::refresh_images(FluidParticles<D>& fluid, std::size_t n) {
  const Vec<D, double>& shift = *needed_[n].image_shift;
  for (const Candidate& candidate : candidates_[n]) {
    // What was too far away for an image at the start of the stay cannot come near in it.
    if (candidate.image == none || !is_needed(fluid, n, candidate)) continue;
    const std::uint32_t image = foreign_[candidate.image];
    for (int axis = 0; axis < D; ++axis) fluid.x(axis)[image] = fluid.x(axis)[candidate.particle] + shift[axis];
    for (std::size_t f = D; f < fluid.field.size(); ++f) fluid.field[f][image] = fluid.field[f][candidate.particle];
    up_to_date_[candidate.image] = 1;
  }
}

template <int D>
bool Residents<D>::refresh(FluidParticles<D>& fluid, BufferReader& reader, std::vector<std::uint32_t>& sequence) {
  const auto count = reader.get<std::uint64_t>();
  const std::byte* const ids = reader.skip<std::uint64_t>(count);
  const std::byte* const fields = reader.skip<double>(count * FluidParticles<D>::field_count);
  const auto value = [&](std::size_t field, std::size_t k) {
    double result;
    std::memcpy(&result, fields + (field * count + k) * sizeof result, sizeof result);
    return result;
  };
  sequence_.assign(count, none);
  double largest_square = 0.0;  // of displacements, rcut^2
  std::size_t expected = 0;     // in `sequence`
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t id;
    std::memcpy(&id, ids + k * sizeof id, sizeof id);
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = value(static_cast<std::size_t>(axis), k);
    double square = 0.0;
    const auto is_that = [&](std::uint32_t n) {
      if (fluid.id[foreign_[n]] != id) return false;
      const Vec<D, double> moved = separation(model_.pair, x - fluid.position(foreign_[n]));
      square = dot(moved, moved);
      return square <= skin * skin;  // another image is a box away
    };
    std::uint32_t found = expected < sequence.size() ? sequence[expected] : none;
    if (found == none || !is_that(found)) {
      const std::uint32_t* probe = probe_of(id);
      while (*probe != none && !is_that(*probe)) probe = next(probe);
      found = *probe;
      if (found == none) {
        if (noticed_.contains(x)) return false;
        continue;
      }
      expected = states_.stood[found];
    }
    largest_square = std::max(largest_square, square);
    for (std::size_t f = 0; f < fluid.field.size(); ++f) fluid.field[f][foreign_[found]] = value(f, k);
    up_to_date_[found] = 1;
    sequence_[k] = found;
    states_.stood[found] = static_cast<std::uint32_t>(k);
    ++expected;
  }
  farthest_ = std::max(farthest_, std::sqrt(largest_square));
  sequence.swap(sequence_);
  return true;
}

template <int D>
void Residents<D>::copy_densities(const FluidParticles<D>& fluid, std::span<double> density) const {
  for (std::size_t n = 0; n < needed_.size(); ++n) {
    if (!needed_[n].image_shift) continue;
    for (const Candidate& candidate : candidates_[n])
      if (candidate.image != none && is_needed(fluid, n, candidate))
        density[foreign_[candidate.image]] = density[candidate.particle];
  }
}

template <int D>
void Residents<D>::take_densities(const FluidParticles<D>& fluid, std::size_t n, BufferReader& reader,
                                  std::span<double> density) {
  const auto count = reader.get<std::uint64_t>();
  const std::byte* const ids = reader.skip<std::uint64_t>(count);
  const std::byte* const values = reader.skip<double>(count);
  if (densities_.of_messages.size() <= n) densities_.of_messages.resize(n + 1);
  std::vector<std::uint32_t>& sequence = densities_.of_messages[n];
  sequence_.assign(count, none);
  std::size_t expected = 0;  // in `sequence`
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t id;
    std::memcpy(&id, ids + k * sizeof id, sizeof id);
    const auto is_that = [&](std::uint32_t at) { return fluid.id[foreign_[at]] == id; };
    std::uint32_t found = expected < sequence.size() ? sequence[expected] : none;
    if (found == none || !is_that(found)) {
      const std::uint32_t* probe = probe_of(id);
      while (*probe != none && !is_that(*probe)) probe = next(probe);
      found = *probe;
      if (found == none) continue;
      expected = densities_.stood[found];
    }
    double value;
    std::memcpy(&value, values + k * sizeof value, sizeof value);
    for (std::uint32_t image = twins_[found];; image = twins_[image]) {
      density[foreign_[image]] = value;
      if (image == found) break;
    }
    sequence_[k] = found;
    densities_.stood[found] = static_cast<std::uint32_t>(k);
    ++expected;
  }
  sequence.swap(sequence_);
}

template <int D>
void Residents<D>::leave(FluidParticles<D>& fluid) {
  if (!staying_) return;
  staying_ = false;
  short_stays_ = steps_ < worthwhile ? short_stays_ + 1 : 0;
  std::vector<std::uint32_t> near_gone, gone;  // in rising order
  for (std::size_t n = 0; n < near_; ++n)
    if (owned_[n] == 0) near_gone.push_back(foreign_[n]);
  gone.reserve(foreign_.size());
  std::merge(near_gone.begin(), near_gone.end(), foreign_.begin() + static_cast<std::ptrdiff_t>(near_), foreign_.end(),
             std::back_inserter(gone));
  std::size_t kept = 0, from = 0;
  const auto keep_until = [&](std::size_t end) {
    if (kept == from) {
      kept = end;
      return;
    }
    const auto move = [&](auto& values) {
      std::copy(values.begin() + static_cast<std::ptrdiff_t>(from), values.begin() + static_cast<std::ptrdiff_t>(end),
                values.begin() + static_cast<std::ptrdiff_t>(kept));
    };
    move(fluid.id);
    for (auto& values : fluid.field) move(values);
    kept += end - from;
  };
  for (const std::uint32_t particle : gone) {
    keep_until(particle);
    from = particle + 1;
  }
  keep_until(fluid.size());
  fluid.resize(kept);
}

#define MAPPM_INSTANTIATE(D)   \
  template class Residents<D>; \
  template Region<D> widened<D>(const Model<D>&, Region<D>, double);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
