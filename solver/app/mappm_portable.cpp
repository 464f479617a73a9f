// mappm of the preset portable: holds the parallel solver once for each instruction set (cmake/portable.cmake), and
// calls the one for the best that the processor has, or for that which --isa names. Compiled for the baseline.
#include <string_view>

using Main = int(int, char**);
using Initialiser = void (*)();

// The entry of each, and its static initialisers, as the linker delimits them.
extern "C" {
Main main_plain, main_avx2, main_avx512;
extern const Initialiser __start_init_plain[], __stop_init_plain[];
extern const Initialiser __start_init_avx2[], __stop_init_avx2[];
extern const Initialiser __start_init_avx512[], __stop_init_avx512[];
}

namespace {

struct Solver {
  std::string_view instruction_set;
  bool runs_here;
  Main* main;
  const Initialiser *first, *end;
};

/// What --isa names; empty where it is not given.
std::string_view wished_set(int argc, char** argv) {
  constexpr std::string_view option = "--isa", with_value = "--isa=";
  for (int n = 1; n < argc; ++n) {
    const std::string_view word = argv[n];
    if (word == option && n + 1 < argc) return argv[n + 1];
    if (word.starts_with(with_value)) return word.substr(with_value.size());
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  // The best last.
  const Solver solvers[] = {
      {"plain", true, main_plain, __start_init_plain, __stop_init_plain},
      {"avx2", __builtin_cpu_supports("x86-64-v3") != 0, main_avx2, __start_init_avx2, __stop_init_avx2},
      {"avx512", __builtin_cpu_supports("x86-64-v4") != 0, main_avx512, __start_init_avx512, __stop_init_avx512},
  };
  const std::string_view wished = wished_set(argc, argv);
  const Solver* chosen = solvers;
  for (const Solver& solver : solvers)
    if (solver.runs_here && chosen->instruction_set != wished) chosen = &solver;
  // A wish that could not be met is refused by the solver itself, once for all processes.
  for (const Initialiser* initialise = chosen->first; initialise != chosen->end; ++initialise) (*initialise)();
  return chosen->main(argc, argv);
}
