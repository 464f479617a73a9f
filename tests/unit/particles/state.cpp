// Oracles: what must and what must not change a digest; sums worked by hand.
#include "particles/state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

namespace mappm {
namespace {

template <int D>
State<D> small_state() {
  State<D> state;
  state.fluid.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    state.fluid.id[i] = 10 + i;
    for (std::size_t f = 0; f < state.fluid.field.size(); ++f)
      state.fluid.field[f][i] = 1024.0 * static_cast<double>(i + 1) + static_cast<double>(f);
  }
  for (const std::uint64_t id : {0u, 1u}) {
    Solid<D> solid;
    solid.id = id;
    for (int axis = 0; axis < D; ++axis) {
      solid.x[axis] = 4096.0 + axis;
      solid.momentum[axis] = (Int128{1} << 70) + axis;
      solid.fluid_impulse[axis] = 7 + axis;
    }
    Contact<D> contact;
    contact.partner = 1 - id;
    contact.stretch[0] = 0.125;
    solid.contacts = {contact};
    state.solids.push_back(solid);
  }
  return state;
}

template <int D>
void expect_independent_of_order_and_shares() {
  const State<D> whole = small_state<D>();
  State<D> turned = whole;
  std::reverse(turned.fluid.id.begin(), turned.fluid.id.end());
  for (auto& values : turned.fluid.field) std::reverse(values.begin(), values.end());
  std::reverse(turned.solids.begin(), turned.solids.end());
  EXPECT_EQ(digest_share(turned), digest_share(whole));

  State<D> first, second;
  for (std::size_t i = 0; i < 4; ++i) {
    FluidParticles<D>& share = i % 3 == 0 ? first.fluid : second.fluid;
    share.id.push_back(whole.fluid.id[i]);
    for (std::size_t f = 0; f < whole.fluid.field.size(); ++f) share.field[f].push_back(whole.fluid.field[f][i]);
  }
  first.solids = {whole.solids[1]};
  second.solids = {whole.solids[0]};
  EXPECT_EQ(digest_share(first) + digest_share(second), digest_share(whole));
  for (int axis = 0; axis < D; ++axis)
    EXPECT_TRUE(momentum_share(first)[axis] + momentum_share(second)[axis] == momentum_share(whole)[axis]);
}

TEST(Digest, does_not_depend_on_order_or_on_the_split_over_processes) {
  expect_independent_of_order_and_shares<2>();
  expect_independent_of_order_and_shares<3>();
}

/// Every word of the state, each changed by its last bit or quantum.
template <int D>
std::vector<std::function<void(State<D>&)>> single_changes() {
  using Change = std::function<void(State<D>&)>;
  std::vector<Change> changes;
  changes.push_back([](State<D>& s) { s.fluid.id[2] += 100; });
  for (std::size_t f = 0; f < FluidParticles<D>::field_count; ++f)
    for (const std::size_t i : {0u, 3u}) changes.push_back([=](State<D>& s) { s.fluid.field[f][i] += 0x1p-40; });
  for (int axis = 0; axis < D; ++axis) {
    changes.push_back([=](State<D>& s) { s.solids[1].x[axis] += 1.0; });
    changes.push_back([=](State<D>& s) { s.solids[1].momentum[axis] += 1; });
    changes.push_back([=](State<D>& s) { s.solids[1].momentum[axis] += Int128{1} << 100; });
    changes.push_back([=](State<D>& s) { s.solids[1].fluid_impulse[axis] += 1; });
    changes.push_back([=](State<D>& s) { s.solids[0].contacts[0].stretch[axis] += 0x1p-55; });
  }
  for (int i = 0; i < angular_components<D>; ++i)
    changes.push_back([=](State<D>& s) { s.solids[1].angular_momentum[i] -= 1; });
  for (int i = 0; i < (D == 2 ? 2 : 4); ++i)
    changes.push_back([=](State<D>& s) { s.solids[0].orientation.component[i] += 0x1p-52; });
  changes.push_back([](State<D>& s) { s.solids[0].id = 9; });
  changes.push_back([](State<D>& s) { s.solids[0].contacts[0].partner = 5; });
  changes.push_back([](State<D>& s) { s.solids[0].contacts[0].own = 1; });
  changes.push_back([](State<D>& s) { s.solids[0].contacts[0].other = 1; });
  changes.push_back([](State<D>& s) { s.solids[0].contacts.clear(); });
  changes.push_back([](State<D>& s) { std::swap(s.fluid.field[0][0], s.fluid.field[0][1]); });
  return changes;
}

template <int D>
void expect_every_change_to_show() {
  std::set<std::uint64_t> digests{digest_share(small_state<D>())};
  for (const auto& change : single_changes<D>()) {
    State<D> state = small_state<D>();
    change(state);
    EXPECT_TRUE(digests.insert(digest_share(state)).second) << "change " << digests.size();
  }
}

TEST(Digest, changes_with_one_bit_of_any_field) {
  expect_every_change_to_show<2>();
  expect_every_change_to_show<3>();
}

TEST(Digest, leaves_out_bookkeeping_and_the_sign_of_zero) {
  State<2> state = small_state<2>();
  state.fluid.v(0)[1] = 0.0;
  const std::uint64_t before = digest_share(state);
  state.fluid.v(0)[1] = -0.0;
  state.solids[0].sampled_impulse[0] = 3;
  state.outside_impulse[1] = 4;
  EXPECT_EQ(digest_share(state), before);
}

TEST(Digest, solids_and_particles_of_one_id_are_told_apart) {
  State<2> empty;
  EXPECT_EQ(digest_share(empty), 0u);
  empty.fluid.resize(1);
  State<2> solid;
  solid.solids.resize(1);
  EXPECT_NE(digest_share(empty), digest_share(solid));
}

TEST(Momentum, by_hand) {
  State<3> state;
  state.fluid.resize(2);
  state.fluid.v(0) = {3.0 * velocity_quantum, -5.0 * velocity_quantum};
  state.fluid.v(1) = {0.5, 0.25};  // 2^47 and 2^46 quanta
  state.fluid.v(2) = {0.0, -velocity_quantum};
  state.solids.resize(2);
  state.solids[0].momentum = {{Int128{1} << 90, 10, 0}};
  state.solids[1].momentum = {{-(Int128{1} << 90), 1, 4}};
  const Vec<3, Int128> sum = momentum_share(state);
  EXPECT_TRUE(sum[0] == -2);
  EXPECT_TRUE(sum[1] == (Int128{1} << 47) + (Int128{1} << 46) + 11);
  EXPECT_TRUE(sum[2] == 3);
}

TEST(Region, holds_its_lower_border_and_not_its_upper) {
  const Region<2> region{{{10.0, 20.0}}, {{12.0, 22.0}}};
  EXPECT_TRUE(region.contains({{10.0, 20.0}}));
  EXPECT_TRUE(region.contains({{11.0, 21.0}}));
  EXPECT_FALSE(region.contains({{12.0, 21.0}}));
  EXPECT_FALSE(region.contains({{10.0, 19.0}}));
  EXPECT_TRUE(Region<3>::whole_box().contains({{0.0, 0.0, box_quanta - 1.0}}));
  EXPECT_FALSE(Region<3>::whole_box().contains({{0.0, 0.0, box_quanta}}));
}

}  // namespace
}  // namespace mappm
