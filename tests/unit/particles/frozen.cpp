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
  place_frozen(model, body, 7, Region<2>::whole_box(), frozen);
  EXPECT_EQ(frozen.size(), 3u);
}

TEST(Frozen, an_impulse_on_one_turns_its_body_by_lever_cross_impulse) {
  const Model<2> model = model_with_frozen<2>();
  Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {});
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
  std::vector<FrozenInStep<3>> frozen;
  place_frozen(model, solid_in_step(model, solid), 0, Region<3>::whole_box(), frozen);
  SolidImpulse<3> load;
  add_frozen_load(frozen.at(0), {{5, 8, 16}}, load);
  EXPECT_TRUE((load.angular == AngularVec<3, Int128>{{0, -16, 8}}));  // lever to the surface, (1, 0, 0) x (5, 8, 16)
}

TEST(Frozen, has_the_volume_and_pressure_of_its_density) {
  FrozenInStep<2> fp;
  set_density(model_with_frozen<2>(), fp, 8.0);
  EXPECT_EQ(fp.density, 8.0);
  EXPECT_EQ(fp.volume.v2, 1.0 / 64.0);
  EXPECT_EQ(fp.volume.pv2, (8.0 - 10.0) / 64.0);  // p = c^2 (rho - rho0)
}

TEST(Frozen, is_shown_with_the_number_of_its_solid) {
  const Model<2> model = model_with_frozen<2>();
  const Solid<2> solid = hand_solid(model, 7, 0, {{2.0, 4.0}}, {{0.25, 0.0}});
  std::vector<FrozenInStep<2>> frozen;
  place_frozen(model, solid_in_step(model, solid), 3, Region<2>::whole_box(), frozen);
  ASSERT_EQ(frozen.size(), 2u);
  set_density(model, frozen[1], 9.5);
  const FrozenPoint<2> point = point_of(frozen[1], solid);
  EXPECT_EQ(point.solid, 7u);
  EXPECT_EQ(point.index, 1u);
  EXPECT_EQ(point.x, (Vec<2, double>{{2.0 / model.pair.length[0], 4.25 / model.pair.length[1]}}));
  EXPECT_EQ(point.v, (Vec<2, double>{{0.25, 0.0}}));
  EXPECT_EQ(point.density, 9.5);
}

TEST(Frozen, of_different_solids_and_of_images_of_one_body_give_each_other_density) {
  Model<2> model = model_with_frozen<2>();
  model.shapes[1].balls.clear();  // a piece of a wall
  const Solid<2> one = hand_solid(model, 0, 0, {{2.0, 4.0}}, {}), other = hand_solid(model, 1, 0, {{6.0, 4.0}}, {});
  EXPECT_TRUE(give_each_other_density(model, one, other, false));
  EXPECT_TRUE(give_each_other_density(model, one, other, true));
  EXPECT_FALSE(give_each_other_density(model, one, one, false)) << "the share of a body in itself is part of its shape";
  EXPECT_TRUE(give_each_other_density(model, one, one, true));
  Solid<2> piece = hand_solid(model, 2, 1, {{2.0, 1.0}}, {}), next = hand_solid(model, 3, 1, {{4.0, 1.0}}, {});
  next.group = piece.group;
  for (const bool images : {false, true}) {
    EXPECT_FALSE(give_each_other_density(model, piece, next, images)) << "they share the layer of one wall";
    EXPECT_FALSE(give_each_other_density(model, piece, piece, images)) << "a wall goes on beyond its piece";
    EXPECT_TRUE(give_each_other_density(model, piece, one, images));
  }
}

}  // namespace
}  // namespace mappm
