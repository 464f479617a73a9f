// What a run needs beside its engine.
#pragma once

#include <string>
#include <vector>

#include "app/options.hpp"
#include "app/start.hpp"
#include "base/group.hpp"
#include "particles/model.hpp"
#include "physics/step_limit.hpp"
#include "scene/scene.hpp"

namespace mappm {

/// `start.state` has gone to the engine.
template <int D>
struct RunSetup {
  const Scene& scene;
  const Model<D>& model;
  const Group& group;
  const RunOptions& options;
  const Start<D>& start;
  const StepLimits& limits;  // of the step, in scene units
  std::string program;
  std::string instruction_set = {};  // that the engine is compiled for
  std::vector<std::string> warnings = {};
  std::string memory = {};           // that is needed, as text
  std::string program_options = {};  // those that only this program has, as given: " --threads 2"
  std::vector<int> domains = {};     // an entry an axis; empty for the reference
  int threads = 1;
  bool faces = false;  // write faces.csv; for engines that keep a ledger of faces
};

}  // namespace mappm
