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

# HDF5 is there twice: serial for the reference, which links no MPI, and over MPI for the parallel solver.
foreach(flavour serial openmpi)
  find_path(HDF5_${flavour}_INCLUDE_DIR hdf5.h PATHS /usr/include/hdf5/${flavour} NO_DEFAULT_PATH REQUIRED)
  find_library(HDF5_${flavour}_LIBRARY hdf5_${flavour} REQUIRED)
  add_library(mappm_hdf5_${flavour} INTERFACE)
  target_include_directories(mappm_hdf5_${flavour} SYSTEM INTERFACE ${HDF5_${flavour}_INCLUDE_DIR})
  target_link_libraries(mappm_hdf5_${flavour} INTERFACE ${HDF5_${flavour}_LIBRARY})
endforeach()
target_link_libraries(mappm_hdf5_openmpi INTERFACE MPI::MPI_CXX)
