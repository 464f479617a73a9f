# Installed as it is: find_package(MaPPM 1.0 CONFIG REQUIRED [COMPONENTS parallel]) reads it.
#   MaPPM::mappm                             a scene on the reference engine (mappm/library/simulation.hpp)
#   MaPPM::physics, particles, scene, ...    the layers by themselves
#   MaPPM::parallel, domains, output_parallel    with the component parallel, which needs MPI and OpenMP
# A program links output_serial (MaPPM::mappm does) or output_parallel, never both: they are one code over two HDF5.
# The libraries are compiled for an instruction set, by default that of the machine which built them.
include(CMakeFindDependencyMacro)
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

find_dependency(fmt)
find_dependency(HDF5Flavours COMPONENTS serial)
include(${CMAKE_CURRENT_LIST_DIR}/MaPPMTargets.cmake)

if("parallel" IN_LIST MaPPM_FIND_COMPONENTS)
  set(MPI_CXX_SKIP_MPICXX TRUE)  # the C interface of MPI is all that is used
  find_dependency(MPI COMPONENTS CXX)
  find_dependency(OpenMP COMPONENTS CXX)
  find_dependency(HDF5Flavours COMPONENTS openmpi)
  include(${CMAKE_CURRENT_LIST_DIR}/MaPPMParallelTargets.cmake)
  set(MaPPM_parallel_FOUND TRUE)
endif()

list(POP_FRONT CMAKE_MODULE_PATH)
foreach(component IN LISTS MaPPM_FIND_COMPONENTS)
  if(MaPPM_FIND_REQUIRED_${component} AND NOT MaPPM_${component}_FOUND)
    set(MaPPM_FOUND FALSE)
    set(MaPPM_NOT_FOUND_MESSAGE "MaPPM has no component ${component}; it has: parallel")
  endif()
endforeach()
