// Oracle: the keys that readers of run.json rely on, and the arithmetic of the ledger in Python's integers.
#include "output/run_record.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/numerics_version.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

RunRecord record() {
  RunRecord record;
  record.program = "mappm";
  record.instruction_set = "avx2";
  record.scene_file = "a/case.toml";
  record.scene_name = "a";
  record.scene_text = "name = 'a'\n";
  record.terms.solids = record.terms.contact = true;
  record.first_step = 5;
  record.step = 25;
  record.time_step = 0.5;
  record.wall_seconds = {{"pairs", 1.5}, {"output", 0.25}};
  record.messages_per_step = 2.0;
  record.bytes_per_step = 1024.0;
  record.neighbours = 1;
  record.orderings = 6;
  record.digest = "00000000000000ff";
  record.start_momentum = {(Int128{1} << 100), -7};
  record.outside_impulse = {-(Int128{1} << 90), 8};
  record.end_momentum = {(Int128{1} << 100) - (Int128{1} << 90), 1};
  record.iota = 0.125;
  record.ranks = 4;
  record.domains = {2, 2};
  record.borders = {{0.0, 0.25, 1.0}, {0.0, 1.5, 2.0}};
  record.particles = 99;
  record.frozen_particles = 12;
  record.solids = 3;
  record.rate = 1e6;
  record.state = "finished";
  return record;
}

TEST(RunRecord, has_every_key_that_readers_rely_on) {
  const auto json = nlohmann::json::parse(run_record_text(record()));
  for (const char* key : {"commit", "compiler", "flags", "instruction_set", "host", "date", "scene", "terms", "steps",
                          "wall_seconds", "digest", "momentum", "ranks", "domains", "threads", "particles",
                          "frozen_particles", "particle_steps_per_second", "state"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["steps"], 25);
  EXPECT_EQ(json["first_step"], 5);
  EXPECT_EQ(json["digest"], "00000000000000ff");
  EXPECT_EQ(json["terms"], nlohmann::json({"fluid", "solids", "contact"}));
  EXPECT_EQ(json["wall_seconds"]["pairs"], 1.5);
  EXPECT_EQ(json["exchange"],
            nlohmann::json({{"neighbours", 1}, {"messages_per_step", 2.0}, {"bytes_per_step", 1024.0}}));
  EXPECT_EQ(json["orderings"], 6);
  EXPECT_EQ(json["domains"], nlohmann::json({2, 2}));
  EXPECT_EQ(json["borders"], nlohmann::json({{0.0, 0.25, 1.0}, {0.0, 1.5, 2.0}}));
  EXPECT_EQ(json["scene"]["text"], "name = 'a'\n");
  EXPECT_EQ(json["numerics_version"], numerics_version);
  EXPECT_FALSE(json.contains("message"));
}

TEST(RunRecord, keeps_the_ledger_as_decimal_strings_of_128_bits) {
  const auto momentum = nlohmann::json::parse(run_record_text(record()))["momentum"];
  EXPECT_EQ(momentum["start"], nlohmann::json({"1267650600228229401496703205376", "-7"}));  // 2**100
  EXPECT_EQ(momentum["impulse"], nlohmann::json({"-1237940039285380274899124224", "8"}));   // -2**90
  EXPECT_EQ(momentum["end"], nlohmann::json({"1266412660188944021221804081152", "1"}));     // 2**100 - 2**90
  EXPECT_EQ(momentum["iota"], 0.125);
}

TEST(RunRecord, is_written_as_a_whole) {
  const testing_tools::ScratchFolder folder;
  write_run_record(folder / "run.json", record());
  RunRecord next = record();
  next.state = "stopped";
  next.message = "a \"quoted\" reason";
  write_run_record(folder / "run.json", next);
  const auto json = nlohmann::json::parse(testing_tools::text_of(folder / "run.json"));
  EXPECT_EQ(json["state"], "stopped");
  EXPECT_EQ(json["message"], "a \"quoted\" reason");
  EXPECT_FALSE(std::filesystem::exists(folder / "run.json.partial"));
  EXPECT_FALSE(
      testing_tools::refusal<InputError>([&] { write_run_record(folder / "none/run.json", record()); }).empty());
}

TEST(TermNames, list_what_the_scene_declares) {
  EXPECT_EQ(term_names(Terms{}), std::vector<std::string>{"fluid"});
  Terms terms;
  terms.transport = terms.extrapolated = terms.body_force = terms.solids = terms.motion = terms.rotation = true;
  terms.contact = terms.force_field = terms.single = true;
  EXPECT_EQ(term_names(terms).size(), 10u);
}

}  // namespace
}  // namespace mappm
