// Oracle: values worked by hand (all operations exact in binary).
#include "physics/state_equation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "base/lanes.hpp"

namespace mappm {
namespace {

TEST(StateEquation, pressure_by_hand) {
  EXPECT_EQ(pressure(10.5, 10.0, 2.0, 0.25), 2.25);  // 4 * 0.5 + 0.25
  EXPECT_EQ(pressure(10.0, 10.0, 2.0, 0.0), 0.0);
  EXPECT_EQ(pressure(8.0, 10.0, 1.0, 0.5), -1.5);
}

TEST(StateEquation, internal_energy_is_the_work_of_compression) {
  // Oracle: Simpson's rule over p / rho^2 from rho0 to rho, from the pressure itself.
  const double rho0 = 9.7, c = 1.3, background = 0.4, rho = 11.2;
  const int intervals = 200;
  double work = 0.0;
  for (int n = 0; n <= intervals; ++n) {
    const double at = rho0 + (rho - rho0) * n / intervals;
    const double weight = n == 0 || n == intervals ? 1.0 : n % 2 == 1 ? 4.0 : 2.0;
    work += weight * pressure(at, rho0, c, background) / (at * at) * (rho - rho0) / (3.0 * intervals);
  }
  EXPECT_NEAR(internal_energy(rho, rho0, c, background), work, 1e-10);  // error of the rule: below 1e-11
  EXPECT_EQ(internal_energy(rho0, rho0, c, background), 0.0);
}

TEST(StateEquation, volume_terms_by_hand) {
  const auto terms = volume_terms(8.0, 10.0, 1.0, 0.5);  // V^2 = 1/64, p = -3/2
  EXPECT_EQ(terms.v2, 0.015625);
  EXPECT_EQ(terms.pv2, -0.0234375);
}

TEST(StateEquation, a_density_is_the_sum_over_others_and_what_is_its_own) {
  EXPECT_EQ(summed_density(std::int64_t{7} << 44, 2.0), 9.0);  // quanta of 2^-44
  const IntLanes sums([](auto lane) { return std::int64_t{3 + lane} << 43; });
  const Lanes densities = summed_density(sums, 0.5);
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(densities[lane], 0.5 * (3 + lane) + 0.5);
}

TEST(StateEquation, a_density_is_in_range_from_a_tenth_of_rest_to_ten_times_it) {
  EXPECT_TRUE(is_in_range(1.0, 10.0) && is_in_range(10.0, 10.0) && is_in_range(100.0, 10.0));
  EXPECT_FALSE(is_in_range(0.999, 10.0));
  EXPECT_FALSE(is_in_range(100.1, 10.0));
  EXPECT_FALSE(is_in_range(std::nan(""), 10.0));
}

TEST(StateEquation, lanes_have_the_bits_of_double) {
  const Lanes rho([](auto lane) { return 9.3 + 0.11 * static_cast<double>(lane); });
  const auto terms = volume_terms(rho, 9.7, 1.0, 0.01);
  for (int lane = 0; lane < lane_count; ++lane) {
    const auto one = volume_terms<double>(rho[lane], 9.7, 1.0, 0.01);
    EXPECT_EQ(terms.v2[lane], one.v2);
    EXPECT_EQ(terms.pv2[lane], one.pv2);
  }
}

}  // namespace
}  // namespace mappm
