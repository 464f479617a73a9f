// The run itself, the same for both engines: steps, and between them samples, snapshots, checkpoints and signals.
#pragma once

#include "app/run_setup.hpp"
#include "particles/engine.hpp"

namespace mappm {

/// Collective. Runs to the end or to a signal; both leave the output complete and print the last line. Throws
/// InputError where output cannot be written and RangeError; run.json then says so.
template <int D>
void run_loop(const RunSetup<D>& setup, Engine<D>& engine);

}  // namespace mappm
