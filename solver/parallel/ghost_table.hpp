// Finds ghosts by the ids that messages name.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace mappm {

/// The numbers of ghosts, 0, 1, 2, ..., by their ids, hashed. Several may be images of one PP and share its id.
class GhostTable {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// ids[n]: that of ghost n.
  void fill(std::vector<std::uint64_t> ids) {
    ids_ = std::move(ids);
    table_.assign(std::bit_ceil(2 * ids_.size() + 1), none);
    next_image_.resize(ids_.size());
    for (std::uint32_t n = 0; n < ids_.size(); ++n) {
      next_image_[n] = n;
      std::size_t at = first(ids_[n]);
      for (; table_[at] != none; at = after(at))
        if (next_image_[n] == n && ids_[table_[at]] == ids_[n]) std::swap(next_image_[n], next_image_[table_[at]]);
      table_[at] = n;
    }
  }
  std::size_t size() const { return ids_.size(); }
  std::uint64_t id(std::uint32_t n) const { return ids_[n]; }

  /// A ghost with this id for which accept(number); `none` if there is none.
  template <class Accept>
  std::uint32_t find(std::uint64_t id, Accept&& accept) const {
    std::size_t at = first(id);
    while (table_[at] != none && !(ids_[table_[at]] == id && accept(table_[at]))) at = after(at);
    return table_[at];
  }
  /// Calls visit(number) for a ghost and all other images of its PP.
  template <class Visit>
  void for_each_image(std::uint32_t n, Visit&& visit) const {
    std::uint32_t image = n;
    do {
      visit(image);
      image = next_image_[image];
    } while (image != n);
  }

 private:
  std::size_t first(std::uint64_t id) const {
    return static_cast<std::size_t>(id * 0x9e3779b97f4a7c15u >> 32) & (table_.size() - 1);
  }
  std::size_t after(std::size_t at) const { return at + 1 == table_.size() ? 0 : at + 1; }

  std::vector<std::uint64_t> ids_;
  std::vector<std::uint32_t> table_;
  std::vector<std::uint32_t> next_image_;  // of each ghost, in a circle; itself where it is alone
};

/// Reads the ids in messages of one kind. One names much the same PPs as the one before from the same sender, in the
/// same order: so a ghost is looked for where it stood then, and in the table only where it is not there.
class MessageOrder {
 public:
  /// To be called where the table was filled anew.
  void clear(std::size_t ghosts) {
    for (auto& sequence : last_) sequence.clear();
    position_.assign(ghosts, 0);
  }

  /// For each of the `count` ids of a message from `sender`, in turn: calls take(k, number) with a ghost of this id for
  /// which accept(k, number), or missing(k) where there is none. False as soon as a call of `missing` is; then the
  /// message has been read in part.
  template <class Accept, class Take, class Missing>
  bool read(std::size_t sender, const std::byte* ids, std::uint64_t count, const GhostTable& table, Accept&& accept,
            Take&& take, Missing&& missing) {
    if (last_.size() <= sender) last_.resize(sender + 1);
    const std::vector<std::uint32_t>& last = last_[sender];
    present_.assign(count, GhostTable::none);
    std::size_t expected = 0;  // in `last`
    for (std::size_t k = 0; k < count; ++k) {
      std::uint64_t id;
      std::memcpy(&id, ids + k * sizeof id, sizeof id);
      std::uint32_t found = expected < last.size() ? last[expected] : GhostTable::none;
      if (found == GhostTable::none || table.id(found) != id || !accept(k, found)) {
        found = table.find(id, [&](std::uint32_t n) { return accept(k, n); });
        if (found == GhostTable::none) {
          if (!missing(k)) return false;
          continue;
        }
        expected = position_[found];
      }
      take(k, found);
      present_[k] = found;
      position_[found] = static_cast<std::uint32_t>(k);
      ++expected;
    }
    last_[sender].swap(present_);
    return true;
  }

 private:
  std::vector<std::vector<std::uint32_t>> last_;  // of each sender: ghosts in the order of its last message, or `none`
  std::vector<std::uint32_t> position_;           // of each ghost in the last message that named it
  std::vector<std::uint32_t> present_;            // of the message that is read
};

}  // namespace mappm
