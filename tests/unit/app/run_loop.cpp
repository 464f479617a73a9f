// Oracle: which files a run must leave, and a motion worked by hand (toy_engine.hpp): after n steps every PP moves at
// n/8.
#include "app/run_loop.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/signals.hpp"
#include "base/single_group.hpp"
#include "output/trace_file.hpp"
#include "unit/app/toy_engine.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::text_of;
using testing_tools::ToyEngine;

class ToyRun : public testing::Test {
 protected:
  ToyRun() {
    stop_signal = 0;
    watch_stop_signals();
    model_.terms = {};
    model_.shapes.clear();
    scene_.name = "toy";
    scene_.text = "name = 'toy'\n";
    scene_.units = Units::dimensionless;
    scene_.run.steps = 12;
    scene_.output.sample = 4;
    options_.scene = "toy.toml";
    options_.out = folder_.path().string();
    options_.quiet = true;
    options_.overwrite = true;
  }
  ~ToyRun() override {
    stop_signal = 0;
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU}) std::signal(number, SIG_DFL);
  }

  /// What the program would do: from step 0, or from the newest checkpoint.
  Start<2> start() {
    if (!options_.resume.empty()) return start_run<2>(scene_, model_, Region<2>::whole_box(), options_, group_);
    Start<2> start{RunFolder(options_.output_folder(scene_.name), entry_of(options_), group_)};
    hand::add_pp(start.state, 0, {{0.25, 0.25}}, {});
    hand::add_pp(start.state, 1, {{0.75, 0.25}}, {});
    return start;
  }
  /// Runs and returns what was printed on standard output.
  std::string run(std::uint64_t bad_step = 0, std::uint64_t signal_step = 0, std::uint64_t full_step = 0) {
    Start<2> begin = start();
    ToyEngine engine(std::move(begin.state));
    engine.bad_step = bad_step;
    engine.signal_step = signal_step;
    engine.full_step = full_step;
    const RunSetup<2> setup{.scene = scene_,
                            .model = model_,
                            .group = group_,
                            .options = options_,
                            .start = begin,
                            .limits = limits_,
                            .program = "toy"};
    testing::internal::CaptureStdout();
    try {
      run_loop(setup, engine);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }
  nlohmann::json record() const { return nlohmann::json::parse(text_of(folder_ / "run.json")); }
  std::string series() const { return text_of(folder_ / "series.csv"); }
  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  testing_tools::ScratchFolder folder_;
  SingleGroup group_;
  Model<2> model_ = hand::model();
  StepLimits limits_;
  Scene scene_;
  RunOptions options_;
};

TEST_F(ToyRun, samples_and_ends_with_the_line_that_scripts_read) {
  const std::string printed = run();
  EXPECT_TRUE(contains(series(), "\n0,0,0,0,0,0,0,0,0,2,1,1,0,0,"));
  // step 4, time 4 x 0.5 x 0.125; v = 4/8 x 4; superficial x 2 PPs / 64; energy 2 x (1/2)(1/4) x 128;
  // angular momentum 2 x (1/2)(1/2) x 16, as both PPs lie 1/2 below the middle of the box;
  // momentum 2 x 1/2 = 2^48 iota, all of it from outside
  EXPECT_TRUE(contains(series(), "\n4,0.25,2,0,0.0625,0,32,0,8,2,1,1,281474976710656,0,281474976710656,0,0,0,"))
      << series();
  EXPECT_TRUE(contains(series(), "\n12,0.75,6,0,"));
  const std::string digest = record()["digest"];
  EXPECT_EQ(printed.rfind("digest " + digest + " step 12 particles 2 ranks 1 particle-steps/s ", 0), 0u) << printed;
  EXPECT_TRUE(contains(series(), digest));
  EXPECT_EQ(files("snapshots"), std::vector<std::string>{"fluid_000000012.vtkhdf"}) << "none but the last";
  EXPECT_FALSE(fs::exists(folder_ / "checkpoints"));
}

TEST_F(ToyRun, traces_the_step_that_was_asked_for) {
  options_.trace = TraceRequest{1, 6};
  run();
  const StepTrace<2> trace{6, 1, {}};
  EXPECT_EQ(text_of(folder_ / "trace.csv"), trace_text(trace, model_.terms.transport));
}

TEST_F(ToyRun, refuses_a_trace_of_a_step_that_it_does_not_make) {
  options_.trace = TraceRequest{1, 12};
  const std::string message = refusal<InputError>([&] { run(); });
  EXPECT_TRUE(contains(message, "--trace = 1@12: this run goes from step 0 to 12; choose a step from 0 to 11"))
      << message;
  EXPECT_FALSE(fs::exists(folder_ / "run.json"));
}

TEST_F(ToyRun, closes_the_ledger_in_its_record) {
  run();
  const auto json = record();
  EXPECT_EQ(json["state"], "finished");
  EXPECT_EQ(json["steps"], 12);
  EXPECT_EQ(json["momentum"]["start"], nlohmann::json({"0", "0"}));
  EXPECT_EQ(json["momentum"]["impulse"], nlohmann::json({"844424930131968", "0"}));  // 12 steps x 2 PPs x 2^45
  EXPECT_EQ(json["momentum"]["end"], json["momentum"]["impulse"]);
  EXPECT_EQ(json["momentum"]["iota"], 8.0 * 4.0 * 0x1p-48);
  EXPECT_EQ(json["wall_seconds"]["toy"], 0.5);
  EXPECT_TRUE(json["wall_seconds"].contains("output"));
}

TEST_F(ToyRun, writes_what_the_scene_asks_for_when_it_asks) {
  scene_.output.snapshot = 5;
  scene_.output.checkpoint = 5;
  scene_.output.solids = true;
  run();
  EXPECT_EQ(files("snapshots"), (std::vector<std::string>{"fluid_000000000.vtkhdf", "fluid_000000005.vtkhdf",
                                                          "fluid_000000010.vtkhdf", "fluid_000000012.vtkhdf"}));
  EXPECT_EQ(files("checkpoints"), (std::vector<std::string>{"checkpoint_000000010.h5", "checkpoint_000000012.h5"}));
  EXPECT_TRUE(fs::exists(folder_ / "solids.csv"));
}

TEST_F(ToyRun, ends_its_tables_with_the_last_state) {
  scene_.output.sample = 5;
  run();
  const std::string through = series();
  EXPECT_TRUE(contains(through, "\n10,") && contains(through, "\n12,")) << through;
  EXPECT_TRUE(contains(through.substr(through.rfind("\n12,")), record()["digest"]));

  scene_.output.checkpoint = 100;  // the last step only
  options_.steps = 7;
  run();
  EXPECT_TRUE(contains(series(), "\n7,")) << series();
  options_.resume = options_.out;
  run();
  EXPECT_TRUE(contains(series(), "\n7,")) << "resumed for no step at all: " << series();
  options_.steps.reset();
  run();
  EXPECT_EQ(series(), through) << "the row of step 7 is none of a run that goes on";
}

TEST_F(ToyRun, tries_its_last_files_before_its_first_step) {
  const auto refused = [&] {
    const testing_tools::SmallDisk disk(2500);
    return contains(refusal<InputError>([&] { run(); }), "snapshots/solids_000000012.vtkhdf.partial");
  };
  EXPECT_TRUE(refused());
  EXPECT_TRUE(fs::is_empty(folder_.path())) << "nothing is left of the attempt";
  run();
  const std::string before = series();
  EXPECT_TRUE(refused());
  EXPECT_EQ(series(), before) << "nothing is lost that was to be overwritten";
  EXPECT_EQ(files("snapshots"), std::vector<std::string>{"fluid_000000012.vtkhdf"});
}

TEST_F(ToyRun, refuses_a_folder_that_holds_a_run) {
  run();
  const std::string before = series();
  options_.overwrite = false;
  const std::string message = refusal<InputError>([&] { run(); });
  EXPECT_TRUE(contains(message, "--out = " + options_.out) && contains(message, "--overwrite")) << message;
  EXPECT_EQ(series(), before);
}

TEST_F(ToyRun, resumed_leaves_the_files_of_one_that_was_not_interrupted) {
  run();
  const std::string through = series();
  const std::string digest = record()["digest"];

  scene_.output.checkpoint = 100;  // the last step only
  options_.steps = 6;              // between two samples
  run();
  options_.resume = options_.out;
  options_.steps.reset();
  run();
  EXPECT_EQ(series(), through);
  EXPECT_EQ(record()["digest"], digest);
  EXPECT_EQ(record()["first_step"], 6);
}

TEST_F(ToyRun, stops_at_a_signal_with_a_checkpoint_and_says_how_to_go_on) {
  scene_.run.steps = 1000;
  options_.overrides = {"a.b=1", "c=it's two"};
  options_.steps = 900;
  const std::string printed = run(0, 5);
  const auto json = record();
  EXPECT_EQ(json["state"], "stopped");
  const std::uint64_t stopped = json["steps"];
  EXPECT_GE(stopped, 5u);
  EXPECT_LE(stopped, 8u) << "the next sample at the latest";
  const std::string path = (folder_ / fmt::format("checkpoints/checkpoint_{:09}.h5", stopped)).string();
  EXPECT_TRUE(fs::exists(path));
  EXPECT_TRUE(
      contains(printed, "resume with: toy run toy.toml --set a.b=1 --set 'c=it'\\''s two' --steps 900 --quiet --out " +
                            options_.out + " --resume " + path))
      << printed;
  EXPECT_TRUE(contains(printed.substr(printed.rfind('\n', printed.size() - 2)), "\ndigest ")) << "the last line";
}

TEST_F(ToyRun, that_left_its_range_writes_nothing_of_it) {
  scene_.output.snapshot = scene_.output.checkpoint = 2;
  EXPECT_EQ(refusal<RangeError>([&] { run(7); }), "step 7: particle 1: v = 99: too fast");
  EXPECT_EQ(files("snapshots").back(), "fluid_000000006.vtkhdf");
  EXPECT_EQ(files("checkpoints").back(), "checkpoint_000000006.h5");
  EXPECT_TRUE(contains(series(), "\n4,"));
  EXPECT_FALSE(contains(series(), "\n8,"));
  EXPECT_EQ(record()["state"], "range error");
  EXPECT_EQ(record()["message"], "step 7: particle 1: v = 99: too fast");
  EXPECT_EQ(record()["steps"], 4) << "the last step that is known to be sound";
}

TEST_F(ToyRun, says_in_its_record_that_it_could_not_write) {
  EXPECT_TRUE(contains(refusal<InputError>([&] { run(0, 0, 1); }), "fluid_000000012.vtkhdf"));
  EXPECT_EQ(record()["state"], "input error");
  EXPECT_TRUE(contains(series(), "\n8,"));
}

TEST_F(ToyRun, refuses_an_output_folder_that_cannot_be_made) {
  options_.out = "/proc/mappm";
  EXPECT_TRUE(contains(refusal<InputError>([&] { run(); }), "/proc/mappm: folder cannot be made"));
}

TEST_F(ToyRun, ends_where_scene_or_command_line_say) {
  scene_.run.relax = 3;
  EXPECT_EQ(last_step(scene_, model_, options_), 15u);
  scene_.run.steps = 0;
  scene_.run.duration = 0.625;  // 10 steps of 0.5 x 0.125
  EXPECT_EQ(last_step(scene_, model_, options_), 13u);
  scene_.run.duration = 0.64;
  EXPECT_EQ(last_step(scene_, model_, options_), 14u) << "not shorter than asked for";
  options_.steps = 7;
  EXPECT_EQ(last_step(scene_, model_, options_), 7u);
}

TEST(RunOptions, name_the_output_after_the_scene) {
  RunOptions options;
  EXPECT_EQ(options.output_folder("a").string(), "out/a");
  options.out = "x/y";
  EXPECT_EQ(options.output_folder("a").string(), "x/y");
}

}  // namespace
}  // namespace mappm
