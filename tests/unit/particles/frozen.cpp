// Oracle: places, levers and torques worked by hand.
#include "particles/frozen.hpp"

#include <gtest/gtest.h>

#include "unit/particles/hand_model.hpp"

namespace mappm {
namespace {

using testing::hand_model;
using testing::hand_solid;

/// The ball of the hand model with two FPs, 1/2 before and 1/4 beside its centre.
template <int D>
Model<D> model_with_frozen() {
  Model<D> model = hand_model<D>();
  FrozenParticle<D> front, side;
  front.offset[0] = 0.5;
  front.normal[0] = 1.0;
  front.depth = 0.5;
  front.own_density = 4.0;
  side.offset[1] = 0.25;
  side.normal[1] = 1.0;
  side.depth = 0.75;
  model.shapes[0].frozen = {front, side};
  return model;
}

TEST(Frozen, only_those_in_the_region_are_placed_with_the_velocity_of_the_body) {
  const Model<2> model = model_with_frozen<2>();
  Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {{0.25, 0.0}});
  solid.density = {8.0, 10.0};
  solid.angular_momentum[0] = Int128{1} << 46;  // inertia 1: omega = 1/4
  const double quantum = model.pair.length[0];
  const Region<2> right{{{2.1 / quantum, 0.0}}, {{8.0 / quantum, box_quanta}}};
  std::vector<FrozenInStep<2>> frozen;
  const SolidInStep<2> body = solid_in_step(model, solid);
  place_frozen(model, body, 6, right, frozen);
  ASSERT_EQ(frozen.size(), 1u);
  EXPECT_EQ(frozen[0].solid, 6u);
  EXPECT_EQ(frozen[0].index, 0u);
  EXPECT_EQ(frozen[0].place.x, (Vec<2, double>{{2.5 / quantum, 4.0 / quantum}}));
  EXPECT_EQ(frozen[0].place.v, (Vec<2, double>{{0.25, 0.125}}));  // v + omega x (1/2, 0)
  EXPECT_EQ(frozen[0].depth, 0.5);
  EXPECT_EQ(frozen[0].own_density, 4.0);
  EXPECT_EQ(frozen[0].volume.v2, 1.0 / 64.0);            // density 8
  EXPECT_EQ(frozen[0].volume.pv2, (8.0 - 10.0) / 64.0);  // p = c^2 (rho - rho0)
  place_frozen(model, body, 7, Region<2>::whole_box(), frozen);
  EXPECT_EQ(frozen.size(), 3u);
}

TEST(Frozen, an_impulse_on_one_turns_its_body_by_lever_cross_impulse) {
  const Model<2> model = model_with_frozen<2>();
  Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {});
  solid.density = {10.0, 10.0};
  solid.orientation.component = {{0.0, 1.0}};  // a quarter turn: the front FP is at (0, 1/2)
  std::vector<FrozenInStep<2>> frozen;
  place_frozen(model, solid_in_step(model, solid), 0, Region<2>::whole_box(), frozen);
  ASSERT_EQ(frozen.size(), 2u);
  EXPECT_EQ(frozen[0].place.normal, (Vec<2, double>{{0.0, 1.0}}));
  SolidImpulse<2> load;
  add_frozen_load(frozen[0], {{8, 3}}, load);
  EXPECT_TRUE((load.linear == Vec<2, Int128>{{8, 3}}));
  EXPECT_TRUE(load.angular[0] == -8);  // lever to the surface, (0, 1): 0 * 3 - 1 * 8
  add_frozen_load(frozen[1], {{0, 16}}, load);
  EXPECT_TRUE((load.linear == Vec<2, Int128>{{8, 19}}));
  EXPECT_TRUE(load.angular[0] == -24);  // surface at (-1, 0): -1 * 16
}

TEST(Frozen, torque_in_space_by_hand) {
  const Model<3> model = model_with_frozen<3>();
  Solid<3> solid = hand_solid(model, 0, 0, {{2.0, 4.0, 1.0}}, {});
  solid.density = {10.0, 10.0};
  std::vector<FrozenInStep<3>> frozen;
  place_frozen(model, solid_in_step(model, solid), 0, Region<3>::whole_box(), frozen);
  SolidImpulse<3> load;
  add_frozen_load(frozen.at(0), {{5, 8, 16}}, load);
  EXPECT_TRUE((load.angular == AngularVec<3, Int128>{{0, -16, 8}}));  // lever to the surface, (1, 0, 0) x (5, 8, 16)
}

TEST(Frozen, density_is_the_sum_and_its_own_bodys_share) {
  FrozenInStep<2> fp;
  fp.own_density = 4.0;
  EXPECT_EQ(frozen_density(fp, std::int64_t{3} << 44), 7.0);  // quantum 2^-44
}

}  // namespace
}  // namespace mappm
