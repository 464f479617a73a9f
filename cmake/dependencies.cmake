# Libraries (see `setup`). Each is known to one layer only. What is not found is said all at once.
set(mappm_missing)

# mappm_need(FOUND WHAT PACKAGE): PACKAGE is that of Debian.
macro(mappm_need found what package)
  if(NOT ${found})
    list(APPEND mappm_missing "${what} (Debian: ${package})")
  endif()
endmacro()

# What `setup` unpacked without root.
if(EXISTS ${CMAKE_SOURCE_DIR}/.libraries)
  list(PREPEND CMAKE_PREFIX_PATH ${CMAKE_SOURCE_DIR}/.libraries/usr)
endif()

find_package(Eigen3 3.4 QUIET NO_MODULE)
mappm_need(Eigen3_FOUND "Eigen 3.4" libeigen3-dev)
find_package(fmt QUIET)
mappm_need(fmt_FOUND "fmt" libfmt-dev)
find_package(CLI11 QUIET)
mappm_need(CLI11_FOUND "CLI11" libcli11-dev)
find_package(nlohmann_json QUIET)
mappm_need(nlohmann_json_FOUND "JSON for Modern C++" nlohmann-json3-dev)
find_package(GTest QUIET)
mappm_need(GTest_FOUND "GoogleTest" libgtest-dev)
find_package(benchmark QUIET)
mappm_need(benchmark_FOUND "Google Benchmark" libbenchmark-dev)
set(MPI_CXX_SKIP_MPICXX TRUE)  # the C interface of MPI is all that is used
find_package(MPI QUIET COMPONENTS CXX)
mappm_need(MPI_CXX_FOUND "MPI" libopenmpi-dev)
find_package(OpenMP QUIET COMPONENTS CXX)
mappm_need(OpenMP_CXX_FOUND "OpenMP" "g++, for clang libomp-dev")
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h)
mappm_need(TOMLPLUSPLUS_INCLUDE_DIR "toml++ 3" libtomlplusplus-dev)
# Serial for the reference, which links no MPI, and over MPI for the parallel solver.
find_package(HDF5Flavours QUIET COMPONENTS serial openmpi)
mappm_need(HDF5Flavours_FOUND "HDF5 over MPI" "libhdf5-dev libhdf5-openmpi-dev")

if(mappm_missing)
  list(JOIN mappm_missing "\n  " text)
  message(FATAL_ERROR "Not found:\n  ${text}\n./setup installs them on Debian and Ubuntu. Elsewhere load their modules, "
    "or name their folders in CMAKE_PREFIX_PATH.")
endif()

add_library(mappm_toml INTERFACE)
target_include_directories(mappm_toml SYSTEM INTERFACE ${TOMLPLUSPLUS_INCLUDE_DIR})
target_compile_definitions(mappm_toml INTERFACE TOML_HEADER_ONLY=1)
