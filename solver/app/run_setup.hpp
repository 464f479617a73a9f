// What a run needs beside its engine.
#pragma once

#include <string>
#include <vector>

#include "app/options.hpp"
#include "app/start.hpp"
#include "base/group.hpp"
#include "particles/model.hpp"
#include "physics/step_limit.hpp"
#include "scene/build.hpp"
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

/// What both programs set alike. `compiled_for`: the instruction set of the engine.
template <int D>
RunSetup<D> make_run_setup(const Scene& scene, const BuiltModel<D>& built, const Group& group,
                           const RunOptions& options, const Start<D>& start, const std::string& program,
                           const std::string& compiled_for, const std::string& memory) {
  RunSetup<D> setup{.scene = scene,
                    .model = built.model,
                    .group = group,
                    .options = options,
                    .start = start,
                    .limits = built.limits,
                    .program = program,
                    .instruction_set = compiled_for,
                    .warnings = built.warnings,
                    .memory = memory};
  setup.warnings.insert(setup.warnings.end(), start.warnings.begin(), start.warnings.end());
  return setup;
}

}  // namespace mappm
