// Runs the tests on all processes of an mpirun together. A failure on any process fails the program on all of them; an
// exception on one ends all, since the others would wait for it.
#include <gtest/gtest.h>

#include <iostream>
#include <string>

#include "mpi/world.hpp"

namespace mappm::testing {

namespace {

const Communicator* communicator = nullptr;

/// The voice of the other processes: failures only.
class FailurePrinter : public ::testing::EmptyTestEventListener {
 public:
  void OnTestStart(const ::testing::TestInfo& info) override {
    test_ = std::string(info.test_suite_name()) + "." + info.name();
  }
  void OnTestPartResult(const ::testing::TestPartResult& result) override {
    if (!result.failed()) return;
    const char* file = result.file_name() != nullptr ? result.file_name() : "";
    std::cerr << "rank " << world().rank() << ": " << test_ << ": " << file << ':' << result.line_number() << ": "
              << result.message() << std::endl;
  }

 private:
  std::string test_;
};

/// The first process reports failures of the others as its own, so that its list of failed tests is complete.
class FailureSharer : public ::testing::EmptyTestEventListener {
 public:
  void OnTestEnd(const ::testing::TestInfo& info) override {
    const std::uint64_t failed = total(info.result()->Failed() ? 1 : 0);
    if (failed > 0 && world().is_first() && !info.result()->Failed())
      std::cerr << "rank 0: " << info.test_suite_name() << '.' << info.name() << " failed on " << failed
                << " other processes" << std::endl;
  }
};

}  // namespace

const Communicator& world() { return *communicator; }

}  // namespace mappm::testing

int main(int argc, char** argv) {
  const mappm::Communicator world(argc, argv);
  mappm::testing::communicator = &world;
  ::testing::InitGoogleTest(&argc, argv);
  GTEST_FLAG_SET(catch_exceptions, false);
  auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (!world.is_first()) {
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new mappm::testing::FailurePrinter);
  }
  listeners.Append(new mappm::testing::FailureSharer);
  const int failed = RUN_ALL_TESTS();
  return mappm::testing::total(failed != 0 ? 1 : 0) == 0 ? 0 : 1;
}
