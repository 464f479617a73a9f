// Oracle: places and values of hand_state.hpp worked by hand; the layout is that of VTK's description of VTKHDF 1.0.
#include "output/snapshot.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "output/hdf5_file.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;

/// Reads a whole data set of doubles; HDF5 converts integers.
std::vector<double> values(const fs::path& path, const std::string& name) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle data(H5Dopen2(file.id(), ("/VTKHDF/" + name).c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(data.id()), H5Sclose);
  std::vector<double> read(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
  H5Dread(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data());
  return read;
}

using Values = std::vector<double>;

class Snapshot : public testing::Test {
 protected:
  Snapshot() {
    State<2> state = hand::state();
    state.solids = {state.solids[0], state.solids[2]};
    write_snapshot(folder_.path(), hand::model(), hand::sample(state), 4, SingleGroup());
  }
  ScratchFolder folder_;
  fs::path fluid_ = folder_ / "fluid_000000006.vtkhdf", solids_ = folder_ / "solids_000000006.vtkhdf";
};

TEST_F(Snapshot, is_an_unstructured_grid_of_vertices) {
  const Hdf5Reader file(fluid_.string());
  EXPECT_EQ(file.text_attribute("/VTKHDF", "Type"), "UnstructuredGrid");
  EXPECT_EQ(file.attribute<std::uint64_t>("/VTKHDF", "Version"), (std::vector<std::uint64_t>{1, 0}));
  for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    EXPECT_EQ(values(fluid_, count), Values{7}) << count;
  EXPECT_EQ(values(fluid_, "Connectivity"), (Values{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(values(fluid_, "Offsets"), (Values{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(values(fluid_, "Types"), Values(7, 1.0));
  EXPECT_EQ(values(fluid_, "FieldData/TimeValue"), Values{0.375});
  EXPECT_EQ(values(fluid_, "FieldData/step"), Values{6});
}

TEST_F(Snapshot, shows_pps_and_fps_in_scene_units) {
  // The free ball, a quarter turn round, has its FP at (1/2 box) + (0, 1/8 rcut); the wall's second FP lies 1/4 below
  // y = 1/8 and comes in again at the top of the box of height 2. Scene lengths are half of these.
  const double ball_x = 1.0, ball_y = 0.5 + 0.0625, wall_x = 1.0;
  EXPECT_EQ(values(fluid_, "Points"), (Values{0.25,   0.25,   0, 0.75,   0.25,   0, 1.25,   0.75,   0, 1.75, 0.75, 0,
                                              ball_x, ball_y, 0, wall_x, 0.0625, 0, wall_x, 0.9375, 0}));
  // FP of the ball: (0.5, -0.25) + 2 x (-1/8, 0), times 4
  EXPECT_EQ(values(fluid_, "PointData/velocity"),
            (Values{2, 0, 0, 1, 2, 0, -1, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 0}));
  // density unit 8 / 0.5^2 = 32; pressure (rho - 8) in units of 32 x 4^2 = 512
  EXPECT_EQ(values(fluid_, "PointData/density"), (Values{224, 256, 288, 256, 272, 272, 272}));
  EXPECT_EQ(values(fluid_, "PointData/pressure"), (Values{-512, 0, 512, 0, 256, 256, 256}));
  EXPECT_EQ(values(fluid_, "PointData/id"), (Values{0, 1, 2, 3, 0, 0, 1}));
  EXPECT_EQ(values(fluid_, "PointData/solid"), (Values{-1, -1, -1, -1, 0, 2, 2}));
  EXPECT_EQ(values(fluid_, "PointData/kind"), (Values{0, 0, 0, 0, 1, 1, 1}));
}

TEST_F(Snapshot, shows_a_point_a_ball) {
  EXPECT_EQ(values(solids_, "Points"), (Values{1, 0.5, 0}));
  EXPECT_EQ(values(solids_, "PointData/radius"), Values{0.125});
  EXPECT_EQ(values(solids_, "PointData/velocity"), (Values{2, -1, 0}));
  EXPECT_EQ(values(solids_, "PointData/angular_velocity"), (Values{0, 0, 16}));
  EXPECT_EQ(values(solids_, "PointData/drag"), (Values{1024, 256, 0}));
  EXPECT_EQ(values(solids_, "PointData/id"), Values{0});
}

TEST_F(Snapshot, of_walls_alone_has_no_file_of_solids) {
  const ScratchFolder& folder = folder_;
  Model<2> model = hand::model();
  model.shapes = {model.shapes[1]};
  State<2> state;
  write_snapshot(folder.path() / "walls", model, hand::sample(state), 0, SingleGroup());
  EXPECT_TRUE(fs::exists(folder / "walls/fluid_000000000.vtkhdf"));
  EXPECT_FALSE(fs::exists(folder / "walls/solids_000000000.vtkhdf"));
}

TEST_F(Snapshot, leaves_nothing_half_written_on_a_full_disk) {
  const fs::path folder = folder_ / "full";
  State<2> state = hand::state();
  const std::string message = [&] {
    const testing_tools::SmallDisk disk(2000);
    return refusal<InputError>([&] { write_snapshot(folder, hand::model(), hand::sample(state), 4, SingleGroup()); });
  }();
  EXPECT_TRUE(contains(message, "cannot be written: File too large")) << message;
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace mappm
