#include "output/face_series.hpp"

#include "output/columns.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

/// A group gathers doubles: 128 bits go as three, of 48, 48 and 32 bits, each an integer that a double holds.
constexpr int digit_bits = 48;
constexpr int digits = 3;

void append(std::vector<double>& to, Int128 value) {
  for (int digit = 0; digit < digits; ++digit) {
    const bool last = digit == digits - 1;
    const Int128 low = last ? value : value & ((Int128{1} << digit_bits) - 1);
    to.push_back(static_cast<double>(static_cast<std::int64_t>(low)));
    value >>= digit_bits;
  }
}

Int128 take(const double*& from) {
  Int128 value = 0;
  for (int digit = 0; digit < digits; ++digit)
    value += static_cast<Int128>(*from++) * (Int128{1} << (digit * digit_bits));
  return value;
}

template <int D>
Columns columns(std::uint64_t step, int rank, const FaceImpulse<D>& face) {
  Columns columns;
  columns.add("step", "", step);
  columns.add("rank", "", rank);
  columns.add("partner", "", face.partner);
  columns.add("impulse", "", face.impulse);
  return columns;
}

}  // namespace

template <int D>
FaceSeries<D>::FaceSeries(const std::filesystem::path& folder, const Group& group,
                          std::optional<std::uint64_t> resumed_step)
    : group_(group) {
  on_first(group, [&] { file_.emplace(folder / "faces.csv", columns<D>(0, 0, {}).header(), resumed_step); });
}

template <int D>
void FaceSeries<D>::add(std::uint64_t step, const std::vector<FaceImpulse<D>>& faces) {
  std::vector<double> mine;
  for (const FaceImpulse<D>& face : faces) {
    mine.push_back(group_.rank());
    mine.push_back(face.partner);
    for (const Int128 component : face.impulse.component) append(mine, component);
  }
  const std::vector<double> all = group_.gather(mine);
  on_first(group_, [&] {
    std::string rows;
    for (const double* next = all.data(); next < all.data() + all.size();) {
      const int rank = static_cast<int>(*next++);
      FaceImpulse<D> face;
      face.partner = static_cast<int>(*next++);
      for (Int128& component : face.impulse.component) component = take(next);
      rows += columns(step, rank, face).row() + '\n';
    }
    file_->add(rows);
  });
}

template class FaceSeries<2>;
template class FaceSeries<3>;

}  // namespace mappm
