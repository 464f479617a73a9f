# Flags that every target shares. The interface target mappm_flags carries those that whoever includes a header of the
# solver needs too, and is installed with it; mappm_build_flags those of this build alone.
add_library(mappm_flags INTERFACE)
add_library(mappm_build_flags INTERFACE)

# Results must have the same bits from every compiler and instruction set: no contraction to fma. No code reads errno,
# so sqrt may be one instruction. The laws are templates and inline functions, which a program that includes them
# compiles anew; of two copies the linker keeps one. So a program outside gets both flags from the installed targets.
target_compile_features(mappm_flags INTERFACE cxx_std_20)
target_compile_options(mappm_flags INTERFACE -ffp-contract=off -fno-math-errno)

# It gets the instruction set too. Bits do not depend on that, but the width of lanes does, and with it the layout of
# types of the parallel engine.
string(TOUPPER "CMAKE_CXX_FLAGS_${CMAKE_BUILD_TYPE}" flags_of_type)

# Some clang cannot compare the widest vectors of some libstdc++ (clang 19 with that of GCC 14): then it takes those of AVX2.
# Results are the same bits.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS "${${flags_of_type}} -std=c++20")
check_cxx_source_compiles("
#include <experimental/simd>
int main(int count, char**) {
  const std::experimental::native_simd<double> x(count);
  return std::experimental::any_of(x > 0.5 * x) ? 0 : 1;
}" MAPPM_COMPILES_WIDEST_VECTORS)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT MAPPM_COMPILES_WIDEST_VECTORS)
  string(APPEND ${flags_of_type} " -mno-avx512f")
endif()

string(REGEX MATCHALL "-m[^ ]+" architecture "${CMAKE_CXX_FLAGS} ${${flags_of_type}}")
target_compile_options(mappm_flags INTERFACE "$<INSTALL_INTERFACE:${architecture}>")

target_compile_options(mappm_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion -Wformat=2)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 starts the AVX-512 intrinsics behind <experimental/simd> from a deliberately undefined register
  # (avx512fintrin.h, `__m512d __Y = __Y`) and then reports it at every use: a false alarm, fixed in GCC 13. Clang
  # still watches for uninitialised variables.
  target_compile_options(mappm_build_flags INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
if(MAPPM_WERROR)
  target_compile_options(mappm_build_flags INTERFACE -Werror)
endif()

if(MAPPM_ASSERTIONS)
  target_compile_options(mappm_build_flags INTERFACE -UNDEBUG)
else()
  target_compile_definitions(mappm_build_flags INTERFACE NDEBUG)
endif()

if(MAPPM_SANITIZE)
  # All of it stops at the first finding, so that a test cannot pass over one.
  target_compile_options(mappm_flags INTERFACE -fsanitize=${MAPPM_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(mappm_flags INTERFACE -fsanitize=${MAPPM_SANITIZE})
  if(MAPPM_SANITIZE MATCHES "address")
    # Reaching beyond an object is what the sanitizer of addresses sees, and this check is a quarter of the time to compile.
    target_compile_options(mappm_flags INTERFACE -fno-sanitize=object-size)
  endif()
endif()
