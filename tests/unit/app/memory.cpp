// Oracle: figures worked by hand for a machine made of a few files.
#include "app/memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <numbers>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;

/// 4 x 2 at a spacing of 1/2: 32 nodes; rcut is 2 spacings, so 4 pi neighbours.
Scene plane_scene() {
  Scene scene;
  scene.file = "scene.toml";
  scene.box = {4.0, 2.0, 0.0};
  scene.fluid.spacing = 0.5;
  scene.fluid.cutoff = 1.0;
  return scene;
}

TEST(MemoryNeed, counts_nodes_axes_and_neighbours) {
  const MemoryNeed need = memory_need(plane_scene(), {.each = 100.0, .an_axis = 10.0, .a_neighbour = 1.0});
  EXPECT_EQ(need.particles, 32.0);
  EXPECT_DOUBLE_EQ(need.bytes, 32.0 * (120.0 + 4.0 * std::numbers::pi));
  EXPECT_EQ(need.text(), "0.0042 MB");
}

TEST(MemoryNeed, of_solids_alone_has_no_particles) {
  Scene scene = plane_scene();
  scene.fluid.particles = false;
  scene.bodies.resize(1);
  scene.bodies[0].positions.resize(1'000'000);
  const MemoryNeed need = memory_need(scene, {.each = 100.0});
  EXPECT_EQ(need.particles, 0.0);
  EXPECT_EQ(need.text(), "2 GB");
}

TEST(CheckMemory, names_key_particles_and_bytes) {
  const MemoryNeed need{1e10, 3.5e15};
  const std::string message = refusal<InputError>([&] { check_memory(plane_scene(), need, SingleGroup()); });
  for (const char* part : {"scene.toml: fluid.spacing = 0.5: makes 1e+10 PPs", "(3.5e+15 bytes)", "are there"})
    EXPECT_TRUE(contains(message, part)) << message;
  check_memory(plane_scene(), {32.0, 1e4}, SingleGroup());
}

class Machine : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    testing_tools::write_text(root_ / path, text);
  }
  double left(int processes = 1) { return memory_left(processes, root_.path()); }

  testing_tools::ScratchFolder root_;
};

TEST_F(Machine, without_any_file_has_no_limit) { EXPECT_GT(left(), 1e30); }

TEST_F(Machine, has_what_is_available_for_its_processes_together) {
  write("proc/meminfo", "MemTotal:  9000 kB\nMemFree: 100 kB\nMemAvailable:  3000 kB\n");
  EXPECT_EQ(left(), 3000.0 * 1024.0);
  EXPECT_EQ(left(3), 1000.0 * 1024.0);
}

TEST_F(Machine, limits_its_control_groups_and_those_above) {
  write("proc/meminfo", "MemAvailable:  3000 kB\n");
  write("proc/self/cgroup", "0::/job/step\n");
  write("sys/fs/cgroup/job/step/memory.max", "max\n");
  write("sys/fs/cgroup/job/memory.max", "500000\n");
  write("sys/fs/cgroup/job/memory.current", "300000\n");
  write("sys/fs/cgroup/job/memory.stat", "anon 200000\ninactive_file 50000\n");
  EXPECT_EQ(left(), 250000.0);
}

TEST_F(Machine, limits_the_control_groups_of_the_first_version) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/b\n");
  write("sys/fs/cgroup/memory/b/memory.limit_in_bytes", "500000\n");
  write("sys/fs/cgroup/memory/b/memory.usage_in_bytes", "300000\n");
  EXPECT_EQ(left(), 200000.0);
}

TEST_F(Machine, limits_the_address_space_of_a_process) {
  write("proc/self/statm", "1000 500 100 10 0 300 0\n");
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit limit{rlim_t{1} << 40, before.rlim_max};
  setrlimit(RLIMIT_AS, &limit);
  EXPECT_EQ(left(8), 0x1p40 - 1000.0 * static_cast<double>(sysconf(_SC_PAGESIZE)));
  setrlimit(RLIMIT_AS, &before);
}

}  // namespace
}  // namespace mappm
