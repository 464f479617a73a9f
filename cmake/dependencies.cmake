# Libraries, all from Debian packages (see `setup`). Each is known to one layer only.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)
set(MPI_CXX_SKIP_MPICXX TRUE)  # the C interface of MPI is all that is used
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(OpenMP REQUIRED COMPONENTS CXX)

find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h REQUIRED)
add_library(mappm_toml INTERFACE)
target_include_directories(mappm_toml SYSTEM INTERFACE ${TOMLPLUSPLUS_INCLUDE_DIR})
target_compile_definitions(mappm_toml INTERFACE TOML_HEADER_ONLY=1)

# Serial for the reference, which links no MPI, and over MPI for the parallel solver.
find_package(HDF5Debian REQUIRED COMPONENTS serial openmpi)
