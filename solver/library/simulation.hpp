// For programs that embed the solver: a scene on the reference engine, its steps and its digest. Two dimensions and
// three look the same from here. A program that wants the particles themselves, or the parallel engine, uses the layers
// below (scene/build.hpp, serial/engine.hpp, parallel/engine.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace mappm {

class Simulation {
 public:
  /// Reads the scene, with `overrides` as in --set ("fluid.spacing=0.02"), and lays the particles of step 0. Throws
  /// InputError, whose message names file, key, value and fix.
  explicit Simulation(const std::string& scene, const std::vector<std::string>& overrides = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Throws RangeError where a value leaves its range; no step may follow.
  void step();
  /// Steps made so far.
  std::uint64_t present_step() const;
  /// PPs and FPs.
  std::uint64_t particles();
  /// Of the whole state: 16 hexadecimal digits, those of the last line of a run.
  std::string digest();
  /// What is doubtful about the scene, a line each.
  const std::vector<std::string>& warnings() const;

  class Engine;  // of either dimension

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace mappm
