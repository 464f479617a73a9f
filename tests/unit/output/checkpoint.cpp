// Oracle: the state before; its digest, and field by field what the digest leaves out.
#include "output/checkpoint.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/numerics_version.hpp"
#include "base/single_group.hpp"
#include "output/file_seal.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;

constexpr const char* scene = "fluid.spacing = 0.5\nrun.relax = 0\n";

class CheckpointFile : public testing::Test {
 protected:
  CheckpointFile() : path_((folder_ / "c.h5").string()) { write_checkpoint(path_, scene, hand::state(), 4, group_); }

  Checkpoint<2> read(const Region<2>& region = Region<2>::whole_box(), const std::string& text = scene) const {
    return read_checkpoint<2>(path_, text, hand::model(), region, group_);
  }
  std::string refused(const Region<2>& region = Region<2>::whole_box(), const std::string& text = scene) const {
    return refusal<InputError>([&] { read(region, text); });
  }
  /// Adds one to the first word of a data set or attribute.
  void alter(const char* data_set, const char* attribute) const {
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    std::vector<std::uint64_t> words(1000);
    if (data_set != nullptr) {
      const hid_t data = H5Dopen2(file, data_set, H5P_DEFAULT);
      H5Dread(data, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data());
      ++words[0];
      H5Dwrite(data, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data());
      H5Dclose(data);
    } else {
      const hid_t data = H5Aopen(file, attribute, H5P_DEFAULT);
      H5Aread(data, H5T_NATIVE_UINT64, words.data());
      ++words[0];
      H5Awrite(data, H5T_NATIVE_UINT64, words.data());
      H5Aclose(data);
    }
    H5Fclose(file);  // cuts the seal off
    seal_file(path_, group_);
  }

  ScratchFolder folder_;
  SingleGroup group_;
  std::string path_;
};

TEST_F(CheckpointFile, gives_back_the_whole_state) {
  const State<2> before = hand::state();
  const Checkpoint<2> read_back = read();
  const State<2>& after = read_back.state;
  EXPECT_EQ(digest_share(after), digest_share(before));
  EXPECT_EQ(after.step, 6u);
  EXPECT_EQ(read_back.sampled_step, 4u);
  EXPECT_EQ(after.fluid.id, before.fluid.id);
  EXPECT_EQ(after.fluid.field, before.fluid.field);
  EXPECT_TRUE(after.start_momentum == before.start_momentum && after.outside_impulse == before.outside_impulse);
  ASSERT_EQ(after.solids.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(after.solids[k].id, before.solids[k].id);
    EXPECT_EQ(after.solids[k].shape, before.solids[k].shape);
    EXPECT_EQ(after.solids[k].group, before.solids[k].group);
    EXPECT_EQ(after.solids[k].motion, before.solids[k].motion);
    EXPECT_TRUE(after.solids[k].sampled_impulse == before.solids[k].sampled_impulse);
    EXPECT_EQ(after.solids[k].contacts.size(), before.solids[k].contacts.size());
  }
  EXPECT_TRUE(after.solids[0].contacts[0].stretch == before.solids[0].contacts[0].stretch);
}

TEST_F(CheckpointFile, holds_the_extremes_of_every_number) {
  State<2> state = hand::state();
  state.fluid.x(0)[0] = 0.0;
  state.fluid.x(1)[0] = box_quanta - 1.0;
  state.fluid.v(0)[0] = -(exact_quanta - 1.0) * velocity_quantum;
  state.solids[0].momentum[0] = -(Int128{1} << 120) - 1;
  state.solids[0].x = {{box_quanta - 1.0, 0.0}};
  write_checkpoint(path_, scene, state, 4, group_);
  EXPECT_EQ(digest_share(read().state), digest_share(state));
}

TEST_F(CheckpointFile, of_an_empty_space_is_one_too) {
  const State<3> state;
  write_checkpoint(path_, scene, state, 0, group_);
  const auto read_back = read_checkpoint<3>(path_, scene, Model<3>{}, Region<3>::whole_box(), group_);
  EXPECT_EQ(read_back.state.fluid.size() + read_back.state.solids.size(), 0u);
}

TEST_F(CheckpointFile, refuses_regions_that_leave_particles_out) {
  Region<2> half = Region<2>::whole_box();
  half.high[0] = 0.5 * box_quanta;
  EXPECT_TRUE(contains(refused(half), "c.h5: is damaged: digest "));
}

TEST_F(CheckpointFile, refuses_another_scene) {
  const std::string message = refused(Region<2>::whole_box(), "fluid.spacing = 0.6\nrun.relax = 0\n");
  EXPECT_TRUE(contains(message, "belongs to another scene: fluid.spacing = 0.6 here and 0.5 in the checkpoint"))
      << message;
}

TEST_F(CheckpointFile, refuses_a_file_cut_short_at_any_length) {
  const auto length = std::filesystem::file_size(path_);
  for (const auto kept : {length - 1, length / 2, std::uintmax_t{100}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(path_, kept);
    EXPECT_TRUE(contains(refused(), "c.h5: cannot be read")) << kept;
  }
}

TEST_F(CheckpointFile, refuses_a_file_of_another_kind) {
  testing_tools::write_text(path_, "no HDF5 at all");
  EXPECT_TRUE(contains(refused(), "c.h5: cannot be read: it is cut short, damaged or no checkpoint"));
  H5Fclose(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  seal_file(path_, group_);
  EXPECT_TRUE(contains(refused(), "attribute 'format' is missing"));
  testing_tools::write_text(path_, "no HDF5 at all, but sealed");
  seal_file(path_, group_);
  EXPECT_TRUE(contains(refused(), "no HDF5 file"));
}

TEST_F(CheckpointFile, refuses_another_version_of_the_format) {
  alter(nullptr, "version");
  EXPECT_TRUE(contains(refused(),
                       "c.h5: has version 5 of the checkpoint format, this program reads version 4; resume "
                       "with the program that wrote it"))
      << refused();
}

TEST_F(CheckpointFile, refuses_what_other_numerics_have_computed) {
  alter(nullptr, "numerics");
  EXPECT_TRUE(
      contains(refused(), fmt::format("c.h5: was computed by numerics version {}, this program has {}: going on "
                                      "would give neither's results; resume with the program that wrote it",
                                      numerics_version + 1, numerics_version)))
      << refused();
}

TEST_F(CheckpointFile, of_a_format_before_the_version_of_numerics_is_refused_for_its_format) {
  const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Adelete(file, "numerics");
  const std::uint64_t two = 2;
  const hid_t version = H5Aopen(file, "version", H5P_DEFAULT);
  H5Awrite(version, H5T_NATIVE_UINT64, &two);
  H5Aclose(version);
  H5Fclose(file);
  seal_file(path_, group_);
  EXPECT_TRUE(contains(refused(), "has version 2 of the checkpoint format")) << refused();
}

TEST_F(CheckpointFile, holds_no_densities) {
  const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_EQ(H5Lexists(file, "/fluid/v_y", H5P_DEFAULT), 1);
  EXPECT_EQ(H5Lexists(file, "/fluid/density", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "/solids/density", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST_F(CheckpointFile, refuses_solids_of_shapes_that_the_scene_has_not) {
  Model<2> model = hand::model();
  model.shapes.resize(1);
  const std::string message =
      refusal<InputError>([&] { read_checkpoint<2>(path_, scene, model, Region<2>::whole_box(), group_); });
  EXPECT_TRUE(contains(message, "its solids have other shapes")) << message;
}

/// A single bit anywhere: in the state (the digest sees it) or in the ledger (the other hash does).
class AlteredCheckpoint : public CheckpointFile, public testing::WithParamInterface<const char*> {};

TEST_P(AlteredCheckpoint, is_refused) {
  const std::string name = GetParam();
  const bool data_set = name[0] == '/';
  alter(data_set ? GetParam() : nullptr, data_set ? nullptr : GetParam());
  EXPECT_TRUE(contains(refused(), "is damaged")) << refused();
}

INSTANTIATE_TEST_SUITE_P(Everywhere, AlteredCheckpoint,
                         testing::Values("/fluid/id", "/fluid/x_x", "/fluid/v_y", "/solids/words", "/solids/contacts",
                                         "start_momentum", "outside_impulse", "step", "sampled_step", "scene_hash",
                                         "digest", "ledger_hash"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

}  // namespace
}  // namespace mappm
