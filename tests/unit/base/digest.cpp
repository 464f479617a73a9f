// Oracles: values worked in Python integers, and what a digest is for: it must not see order, and see every bit.
#include "base/digest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>

namespace mappm {
namespace {

std::uint64_t hash_of(std::uint64_t id, double x, double v) { return ParticleHash(id).add(x).add(v).value(); }

TEST(ParticleHash, is_a_chain_of_the_finaliser_of_splitmix64) {
  // The header's recurrence, worked independently in Python with integers modulo 2^64 (mix as in Steele et al.):
  //   s = 0x6d6170706d000001; for w in words: s = mix(s ^ mix(w + 0x9e3779b97f4a7c15))
  EXPECT_EQ(ParticleHash(0).value(), 0xb182edfa69b8cce0u);
  EXPECT_EQ(ParticleHash(1).add(std::uint64_t{2}).value(), 0x25eef395bb235b86u);
  EXPECT_EQ(ParticleHash(7).add(1.0).value(), 0xe3021e01229c223cu);
}

TEST(ParticleHash, sees_every_single_bit_of_its_words) {
  std::set<std::uint64_t> seen{hash_of(5, 1.0, 2.0)};
  for (int bit = 0; bit < 64; ++bit) {
    const std::uint64_t flip = std::uint64_t{1} << bit;
    seen.insert(hash_of(5 ^ flip, 1.0, 2.0));
    seen.insert(ParticleHash(5).add(std::bit_cast<std::uint64_t>(1.0) ^ flip).add(2.0).value());
  }
  EXPECT_EQ(seen.size(), 129u);
}

TEST(ParticleHash, sees_both_words_of_a_wide_integer) {
  const Int128 wide = (Int128{3} << 64) + 9;
  EXPECT_EQ(ParticleHash(1).add(wide).value(), ParticleHash(1).add(std::uint64_t{9}).add(std::uint64_t{3}).value());
  EXPECT_NE(ParticleHash(1).add(wide).value(), ParticleHash(1).add(wide + (Int128{1} << 100)).value());
  EXPECT_NE(ParticleHash(1).add(Int128{-1}).value(), ParticleHash(1).add(Int128{1}).value());
}

TEST(ParticleHash, counts_minus_zero_as_zero) { EXPECT_EQ(hash_of(1, 0.0, 3.0), hash_of(1, -0.0, 3.0)); }

TEST(Digest, is_a_sum_that_does_not_see_the_order_of_particles_but_whose_value_is_whose) {
  const std::array<double, 3> x{1.0, 2.0, 3.0};
  std::uint64_t forward = 0, backward = 0;
  for (std::size_t i = 0; i < 3; ++i) forward += hash_of(i, x[i], 0.0);
  for (std::size_t i = 3; i-- > 0;) backward += hash_of(i, x[i], 0.0);
  EXPECT_EQ(forward, backward);
  const std::uint64_t exchanged = hash_of(1, x[0], 0.0) + hash_of(0, x[1], 0.0) + hash_of(2, x[2], 0.0);
  EXPECT_NE(forward, exchanged);
  EXPECT_NE(forward, forward - hash_of(2, x[2], 0.0) + hash_of(2, std::nextafter(x[2], 4.0), 0.0));
}

}  // namespace
}  // namespace mappm
