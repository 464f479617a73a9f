#include "parallel/residents.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

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
void Residents<D>::settle(const FluidParticles<D>& fluid, StayLength length) {
  sort_out(fluid);
  schedule_.begin(length);
  up_to_date_.assign(foreign_.size(), 0);
  std::vector<std::uint64_t> ids;
  ids.reserve(foreign_.size());
  for (const std::uint32_t i : foreign_) ids.push_back(fluid.id[i]);
  table_.fill(std::move(ids));
  find_images(fluid);
  states_.clear(foreign_.size());
  densities_.clear(foreign_.size());
}

/// What can be needed elsewhere, and what is or can become another's.
template <int D>
void Residents<D>::sort_out(const FluidParticles<D>& fluid) {
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
}

template <int D>
void Residents<D>::find_images(const FluidParticles<D>& fluid) {
  for (std::size_t n = 0; n < needed_.size(); ++n) {
    if (!needed_[n].image_shift) continue;
    for (Candidate& candidate : candidates_[n]) {
      const Vec<D, double> image = fluid.position(candidate.particle) + *needed_[n].image_shift;
      candidate.image = table_.find(fluid.id[candidate.particle],
                                    [&](std::uint32_t k) { return fluid.position(foreign_[k]) == image; });
    }
  }
}

template <int D>
void Residents<D>::select(const FluidParticles<D>& fluid, std::size_t n, std::vector<std::uint32_t>& chosen) const {
  for (const Candidate& candidate : candidates_[n])
    if (is_needed(fluid, n, candidate)) chosen.push_back(candidate.particle);
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
  for (std::size_t n = 0; n < readers.size(); ++n)
    if (!refresh(fluid, readers[n], n)) return false;
  if (!schedule_.lasts()) return false;
  for (std::size_t n = 0; n < foreign_.size(); ++n)
    if (up_to_date_[n] == 0 && noticed_.contains(fluid.position(foreign_[n]))) return false;
  schedule_.add_step();
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

/// False where a PP comes near that was not here.
template <int D>
bool Residents<D>::refresh(FluidParticles<D>& fluid, BufferReader& reader, std::size_t sender) {
  const auto count = reader.get<std::uint64_t>();
  const std::byte* const ids = reader.skip<std::uint64_t>(count);
  const std::byte* const fields = reader.skip<double>(count * FluidParticles<D>::field_count);
  const auto value = [&](std::size_t field, std::size_t k) {
    double result;
    std::memcpy(&result, fields + (field * count + k) * sizeof result, sizeof result);
    return result;
  };
  const auto position = [&](std::size_t k) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = value(static_cast<std::size_t>(axis), k);
    return x;
  };
  double square = 0.0, largest_square = 0.0;  // of displacements, rcut^2
  const bool all_known = states_.read(
      sender, ids, count, table_,
      [&](std::size_t k, std::uint32_t n) {
        const Vec<D, double> moved = separation(model_.pair, position(k) - fluid.position(foreign_[n]));
        square = dot(moved, moved);
        return square <= skin * skin;  // another image is a box away
      },
      [&](std::size_t k, std::uint32_t n) {
        largest_square = std::max(largest_square, square);
        for (std::size_t f = 0; f < fluid.field.size(); ++f) fluid.field[f][foreign_[n]] = value(f, k);
        up_to_date_[n] = 1;
      },
      [&](std::size_t k) { return !noticed_.contains(position(k)); });
  if (all_known) schedule_.ghosts_moved(std::sqrt(largest_square));
  return all_known;
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
void Residents<D>::take_densities(std::size_t sender, BufferReader& reader, std::span<double> density) {
  const auto count = reader.get<std::uint64_t>();
  const std::byte* const ids = reader.skip<std::uint64_t>(count);
  const std::byte* const values = reader.skip<double>(count);
  densities_.read(
      sender, ids, count, table_, [](std::size_t, std::uint32_t) { return true; },
      [&](std::size_t k, std::uint32_t n) {
        double value;
        std::memcpy(&value, values + k * sizeof value, sizeof value);
        table_.for_each_image(n, [&](std::uint32_t image) { density[foreign_[image]] = value; });
      },
      [](std::size_t) { return true; });
}

template <int D>
void Residents<D>::leave(FluidParticles<D>& fluid) {
  if (!staying()) return;
  schedule_.end();
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
