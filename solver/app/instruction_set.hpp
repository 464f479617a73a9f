// The instruction set that the compiler was allowed. Layers that all sets share are compiled for the first, so this is
// for the main programs alone.
#pragma once

#include <array>

namespace mappm {

/// Each holds those before it: lanes of two, four and eight. Other processors than x86-64 have the first.
inline constexpr std::array instruction_sets{"plain", "avx2", "avx512"};

#if defined(__AVX512F__)
inline constexpr const char* instruction_set = instruction_sets[2];
#elif defined(__AVX2__)
inline constexpr const char* instruction_set = instruction_sets[1];
#else
inline constexpr const char* instruction_set = instruction_sets[0];
#endif

}  // namespace mappm
