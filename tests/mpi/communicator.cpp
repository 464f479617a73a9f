// Oracle: values that each process can work out for itself from its rank.
#include "parallel/communicator.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mpi/world.hpp"
#include "parallel/message.hpp"

namespace mappm {
namespace {

using testing::world;

TEST(CommunicatorSums, of_wide_integers_are_exact) {
  const Int128 rank = world().rank(), size = world().size();
  const Int128 two_64 = Int128{1} << 64, two_100 = Int128{1} << 100;
  std::vector<Int128> values{rank,
                             -rank - 1,
                             two_64 * (rank + 1),
                             -two_100 + rank,
                             rank % 2 == 0 ? two_100 : -two_100,
                             (Int128{1} << 43) - 1,
                             -(Int128{1} << 86),
                             (Int128{1} << 120) / size};
  world().sum(values);
  const Int128 sum_of_ranks = size * (size - 1) / 2;
  EXPECT_TRUE(values[0] == sum_of_ranks);
  EXPECT_TRUE(values[1] == -sum_of_ranks - size);
  EXPECT_TRUE(values[2] == two_64 * (sum_of_ranks + size));
  EXPECT_TRUE(values[3] == -two_100 * size + sum_of_ranks);
  EXPECT_TRUE(values[4] == (size % 2 == 0 ? 0 : two_100));
  EXPECT_TRUE(values[5] == ((Int128{1} << 43) - 1) * size);
  EXPECT_TRUE(values[6] == -(Int128{1} << 86) * size);
  EXPECT_TRUE(values[7] == (Int128{1} << 120) / size * size);
}

TEST(CommunicatorSums, of_words_wrap_around) {
  std::vector<std::uint64_t> values{std::uint64_t{1} << 63, ~std::uint64_t{0}, 5};
  world().sum(values);
  const auto size = static_cast<std::uint64_t>(world().size());
  EXPECT_EQ(values[0], size % 2 == 0 ? 0u : std::uint64_t{1} << 63);
  EXPECT_EQ(values[1], std::uint64_t{0} - size);
  EXPECT_EQ(values[2], 5 * size);
}

TEST(CommunicatorSums, minimum_maximum_and_sum_before) {
  const double rank = world().rank();
  std::vector<double> low{rank, -rank}, high{rank, -rank};
  world().minimum(low);
  world().maximum(high);
  EXPECT_EQ(low, (std::vector<double>{0.0, 1.0 - world().size()}));
  EXPECT_EQ(high, (std::vector<double>{world().size() - 1.0, 0.0}));
  const auto r = static_cast<std::uint64_t>(world().rank());
  EXPECT_EQ(world().sum_before(r + 10), r * (r - 1) / 2 + 10 * r);
}

TEST(CommunicatorTexts, are_broadcast_from_any_rank) {
  for (int root = 0; root < world().size(); ++root) {
    const std::string text = "rank " + std::to_string(world().rank());
    EXPECT_EQ(world().broadcast(text, root), "rank " + std::to_string(root));
    EXPECT_EQ(world().broadcast(world().rank() == root ? "" : "not empty", root), "");
  }
}

TEST(CommunicatorGather, is_in_the_order_of_ranks_on_the_first) {
  // Rank r gives r values.
  const std::vector<double> own(static_cast<std::size_t>(world().rank()), 1.5 * world().rank());
  const std::vector<double> all = world().gather(own);
  std::vector<double> expected;
  if (world().is_first())
    for (int rank = 0; rank < world().size(); ++rank)
      for (int n = 0; n < rank; ++n) expected.push_back(1.5 * rank);
  EXPECT_EQ(all, expected);
}

/// A message whose length and content tell sender, receiver and turn.
Buffer message(int from, int to, int turn) {
  Buffer buffer;
  put(buffer,
      std::vector<int>(static_cast<std::size_t>((7 * from + 3 * to + turn) % 5 * 1000), 100 * from + 10 * to + turn));
  return buffer;
}

TEST(CommunicatorExchange, with_all_partners_and_itself) {
  const int rank = world().rank();
  std::vector<int> partners;
  for (int other = 0; other < world().size(); ++other) partners.push_back(other);
  std::vector<Buffer> out(partners.size()), in(partners.size());
  for (int turn = 0; turn < 3; ++turn) {
    for (std::size_t n = 0; n < partners.size(); ++n) out[n] = message(rank, partners[n], turn);
    world().exchange(partners, out, in);
    for (std::size_t n = 0; n < partners.size(); ++n) EXPECT_EQ(in[n], message(partners[n], rank, turn));
  }
}

TEST(CommunicatorExchange, with_a_partner_on_both_sides_keeps_the_order) {
  // In a ring of two, or of one, the neighbours to the left and to the right are the same process.
  const int rank = world().rank(), size = world().size();
  if (size > 2) return;
  const int other = (rank + 1) % size;
  const std::vector<int> partners{other, other};
  std::vector<Buffer> out{message(rank, other, 0), message(rank, other, 1)}, in(2);
  world().exchange(partners, out, in);
  EXPECT_EQ(in[0], message(other, rank, 0));
  EXPECT_EQ(in[1], message(other, rank, 1));
}

TEST(CommunicatorExchange, with_no_partner_and_with_empty_messages) {
  world().exchange({}, {}, {});
  std::vector<int> partners{world().rank()};
  std::vector<Buffer> out(1), in{message(1, 2, 3)};
  world().exchange(partners, out, in);
  EXPECT_TRUE(in[0].empty());
}

TEST(CommunicatorExchange, of_all_with_all) {
  std::vector<Buffer> out;
  for (int other = 0; other < world().size(); ++other) out.push_back(message(world().rank(), other, 4));
  const std::vector<Buffer> in = world().exchange_all(std::move(out));
  EXPECT_EQ(in.size(), static_cast<std::size_t>(world().size()));
  for (int other = 0; other < world().size(); ++other)
    EXPECT_EQ(in[static_cast<std::size_t>(other)], message(other, world().rank(), 4));
}

TEST(Messages, are_read_back_in_order) {
  Buffer buffer;
  put(buffer, 7);
  put(buffer, std::vector<double>{1.0, 2.0});
  put(buffer, std::vector<char>{});
  put(buffer, Int128{-3});
  BufferReader reader(buffer);
  EXPECT_EQ(reader.get<int>(), 7);
  std::vector<double> values;
  reader.get(values);
  EXPECT_EQ(values, (std::vector<double>{1.0, 2.0}));
  std::vector<char> none{'x'};
  reader.get(none);
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(reader.at_end());
  EXPECT_TRUE(reader.get<Int128>() == -3);
  EXPECT_TRUE(reader.at_end());
}

}  // namespace
}  // namespace mappm
