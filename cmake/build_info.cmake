# Writes build_info.hpp: commit, compiler and flags, for run.json. The commit is read at every build, not once at
# configuration; the header is rewritten only where it changed.
string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_RELEASE} -std=c++20 -ffp-contract=off -fno-math-errno)
set(MAPPM_GENERATED_DIR ${CMAKE_BINARY_DIR}/generated)
add_custom_target(mappm_write_build_info
  COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${CMAKE_SOURCE_DIR} -D OUTPUT=${MAPPM_GENERATED_DIR}/build_info.hpp
    "-D COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" "-D FLAGS=${flags}"
    "-D VERSION=${PROJECT_VERSION}"
    "-D PORTABLE=$<IF:$<BOOL:${MAPPM_PORTABLE}>,true,false>" -P ${CMAKE_CURRENT_LIST_DIR}/write_build_info.cmake
  BYPRODUCTS ${MAPPM_GENERATED_DIR}/build_info.hpp
  VERBATIM)
add_library(mappm_build_info INTERFACE)
target_include_directories(mappm_build_info INTERFACE ${MAPPM_GENERATED_DIR})
add_dependencies(mappm_build_info mappm_write_build_info)
