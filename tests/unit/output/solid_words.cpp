// Oracle: the fields of a solid, counted and compared one by one.
#include "output/solid_words.hpp"

#include <gtest/gtest.h>

#include "unit/output/hand_state.hpp"

namespace mappm {
namespace {

TEST(SolidWords, have_a_length_that_follows_from_the_fields) {
  // id, shape, group, motion, x, 2 words for each of momentum, angular momentum and two impulses, orientation, the
  // number of contacts
  EXPECT_EQ(solid_word_count<2>(), 4u + 2 + 2 * (2 + 1 + 2 + 2) + 2 + 1);
  EXPECT_EQ(solid_word_count<3>(), 4u + 3 + 2 * (3 + 3 + 3 + 3) + 4 + 1);
  EXPECT_EQ(contact_word_count<2>(), 5u);
}

TEST(SolidWords, read_back_to_the_same_solid) {
  Solid<2> solid = hand::state().solids[0];
  solid.shape = 3;
  solid.group = 9;
  solid.momentum[1] = -(Int128{1} << 100) + 12345;  // both words, and the sign
  solid.orientation.component = {{-0.0, 0x1.fffffffffffffp-1}};
  std::vector<std::uint64_t> words;
  append_words(solid, words);
  const auto read = solid_of_words<2>(words.data());
  EXPECT_EQ(read.id, solid.id);
  EXPECT_EQ(read.shape, 3u);
  EXPECT_EQ(words[solid_shape_word], 3u);
  EXPECT_EQ(read.group, 9u);
  EXPECT_EQ(read.motion, solid.motion);
  EXPECT_TRUE(read.x == solid.x && read.momentum == solid.momentum);
  EXPECT_TRUE(read.angular_momentum == solid.angular_momentum);
  EXPECT_TRUE(read.fluid_impulse == solid.fluid_impulse && read.sampled_impulse == solid.sampled_impulse);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(read.orientation.component[0]), std::bit_cast<std::uint64_t>(-0.0));
  EXPECT_EQ(read.orientation.component[1], 0x1.fffffffffffffp-1);
  EXPECT_EQ(read.contacts.size(), 1u);
}

TEST(ContactWords, read_back_to_the_same_contact) {
  const Contact<2> contact{5, 6, 7, {{0.1, -1e-300}}};
  std::vector<std::uint64_t> words;
  visit_contact_fields(contact, WordWriter(words));
  Contact<2> read;
  visit_contact_fields(read, WordReader(words.data()));
  EXPECT_TRUE(read.partner == 5 && read.own == 6 && read.other == 7 && read.stretch == contact.stretch);
}

}  // namespace
}  // namespace mappm
