// Where a run begins: at step 0 of its scene, or at a checkpoint.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/options.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "output/checkpoint_folder.hpp"
#include "output/run_folder.hpp"
#include "output/together.hpp"
#include "scene/build.hpp"
#include "scene/scene.hpp"

namespace mappm {

template <int D>
struct Start {
  RunFolder folder;
  State<D> state = {};
  std::optional<std::uint64_t> resumed_step = {};  // none: from step 0
  std::uint64_t sampled_step = 0;                  // of the last sample
  std::vector<std::string> warnings = {};
};

inline RunFolder::Entry entry_of(const RunOptions& options) {
  if (!options.resume.empty()) return RunFolder::Entry::resume;
  return options.overwrite ? RunFolder::Entry::overwrite : RunFolder::Entry::refuse;
}

/// The step at which a run ends: what the command line says, or else relaxation and duration of the scene.
template <int D>
std::uint64_t last_step(const Scene& scene, const Model<D>& model, const RunOptions& options) {
  if (options.steps.has_value()) return *options.steps;
  if (scene.run.steps > 0) return scene.run.relax + scene.run.steps;
  // A duration of a whole number of steps may come out a rounding error above it.
  const double steps = scene.run.duration / (model.dt * model.units.time());
  if (steps > static_cast<double>(last_countable_step))
    throw InputError(scene.file, "run.duration", fmt::format("{}", scene.run.duration),
                     fmt::format("is {:.3g} steps, more than can be counted; shorten it", steps));
  return scene.run.relax + static_cast<std::uint64_t>(std::ceil(steps * (1.0 - 1e-12)));
}

/// A run that is to end before the step of its checkpoint cannot; one that is to end there makes no step.
template <int D>
void check_end(const Scene& scene, const Model<D>& model, const RunOptions& options, const std::string& checkpoint,
               Start<D>& start) {
  const std::uint64_t last = last_step(scene, model, options), first = *start.resumed_step;
  if (last > first) return;
  const std::string file = options.steps ? "command line" : scene.file;
  const std::string key = options.steps ? "--steps" : scene.run.steps > 0 ? "run.steps" : "run.duration";
  const std::string reached = fmt::format("{} is of step {}", checkpoint, first);
  if (last < first)
    throw InputError(file, key, "",
                     fmt::format("the run ends at step {}, and {}; let it end later, or resume an earlier checkpoint",
                                 last, reached));
  start.warnings.push_back(fmt::format("{}: {}, the last: no step is made", key, reached));
}

/// Collective. Takes the output folder, then what of the state lies in `region`. Throws InputError.
template <int D>
Start<D> start_run(const Scene& scene, const Model<D>& model, const Region<D>& region, const RunOptions& options,
                   const Group& group) {
  Start<D> start{RunFolder(options.output_folder(scene.name), entry_of(options), group)};
  if (options.resume.empty()) {
    start.state = together(group, [&] { return build_state<D>(scene, model, region); });
    start.state.start_momentum = momentum_share(start.state);
    group.sum(std::span<Int128>(start.state.start_momentum.component));
    return start;
  }
  auto found = find_checkpoint<D>(options.resume, scene.identity, model, region, group);
  start.state = std::move(found.checkpoint.state);
  start.resumed_step = start.state.step;
  start.sampled_step = found.checkpoint.sampled_step;
  if (!found.warning.empty())
    start.warnings.push_back(found.warning + "; resumed from " + found.path.string() + " instead");
  check_end(scene, model, options, found.path.string(), start);
  return start;
}

}  // namespace mappm
