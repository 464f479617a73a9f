#include "scene/velocity_field.hpp"

#include <fmt/format.h>

namespace mappm {

namespace {

using Kind = FlowField::Kind;

constexpr std::pair<const char*, Kind> kinds[] = {
    {"wave", Kind::wave}, {"vortices", Kind::vortices}, {"abc", Kind::abc}};

constexpr std::uint64_t most_waves = 1'000'000;

void check_sides(const Fields& table, const char* key, const Triple& box) {
  for (int axis = 1; axis < table.source().dimension; ++axis)
    if (const double side = box[static_cast<std::size_t>(axis)]; side != box[0])
      table.fail(key, fmt::format("needs a box of equal sides, and this one has {} and {}; change box.size or write "
                                  "wave instead",
                                  box[0], side));
}

}  // namespace

std::optional<FlowField> read_flow(const Fields& table, Quantity quantity, const Triple& box) {
  std::optional<FlowField> field;
  const char* first = nullptr;
  for (const auto& [key, kind] : kinds) {
    const std::optional<Fields> declared = table.table(key);
    if (!declared) continue;
    if (first) table.fail(key, fmt::format("{} is given too; keep one of wave, vortices, abc", first));
    first = key;
    if (kind == Kind::abc && table.source().dimension == 2)
      table.fail(key, "the box has two sides; write vortices or give it a third");
    if (kind != Kind::wave) check_sides(table, key, box);
    field = FlowField{kind, declared->number("amplitude", quantity, Sign::any), 1, 0, 1};
    if (kind == Kind::wave) {
      field->direction = declared->axis("direction");
      field->gradient = declared->axis("gradient");
    }
    const std::uint64_t mode = declared->count("mode", 1);
    if (mode == 0 || mode > most_waves)
      declared->fail("mode", fmt::format("must be 1 to {}: waves per box side", most_waves));
    field->mode = static_cast<int>(mode);
    declared->finish();
  }
  return field;
}

template <int D>
InitialVelocity<D>::InitialVelocity(const FluidScene& fluid, const UnitScale& units)
    : fluid_(fluid), unit_(units.velocity), flow_(fluid.flow), uniform_(rounded({})) {}

template <int D>
Vec<D, double> InitialVelocity<D>::rounded(const Vec<D, double>& varying) const {
  Vec<D, double> v;
  for (int axis = 0; axis < D; ++axis) {
    const double speed = fluid_.velocity[static_cast<std::size_t>(axis)] + varying[axis];
    v[axis] = round_to_quantum(speed / unit_, velocity_quantum);
  }
  return v;
}

template class InitialVelocity<2>;
template class InitialVelocity<3>;

}  // namespace mappm
