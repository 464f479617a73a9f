# Flags that every target shares, carried by the interface target mappm_flags.
add_library(mappm_flags INTERFACE)

# Results must have the same bits from every compiler and instruction set: no contraction to fma. No code reads errno,
# so sqrt may be one instruction.
target_compile_options(mappm_flags INTERFACE -ffp-contract=off -fno-math-errno)

target_compile_options(mappm_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion -Wformat=2)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 starts the AVX-512 intrinsics behind <experimental/simd> from a deliberately undefined register
  # (avx512fintrin.h, `__m512d __Y = __Y`) and then reports it at every use: a false alarm, fixed in GCC 13. Clang
  # still watches for uninitialised variables.
  target_compile_options(mappm_flags INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
if(MAPPM_WERROR)
  target_compile_options(mappm_flags INTERFACE -Werror)
endif()

if(MAPPM_ASSERTIONS)
  target_compile_options(mappm_flags INTERFACE -UNDEBUG)
else()
  target_compile_definitions(mappm_flags INTERFACE NDEBUG)
endif()

if(MAPPM_SANITIZE)
  # All of it stops at the first finding, so that a test cannot pass over one.
  target_compile_options(mappm_flags INTERFACE -fsanitize=${MAPPM_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(mappm_flags INTERFACE -fsanitize=${MAPPM_SANITIZE})
endif()
