// Oracle: the form of a message as the header gives it.
#include "base/error.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

TEST(InputError, names_file_key_value_and_fix) {
  EXPECT_STREQ(InputError("a.toml", "fluid.spacing", "-1", "must be above 0").what(),
               "a.toml: fluid.spacing = -1: must be above 0");
  EXPECT_STREQ(InputError("a.toml", "fluid.spacing", "", "missing; give a length").what(),
               "a.toml: fluid.spacing: missing; give a length");
}

}  // namespace
}  // namespace mappm
