# `cmake --install build/PRESET --prefix FOLDER`: the two programs, the layers as static libraries with their headers,
# and a package that find_package(MaPPM) finds. What needs MPI is its component `parallel`.
if(MAPPM_PORTABLE)  # layers are compiled for several instruction sets, and make one program alone
  install(TARGETS mappm)
  return()
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/MaPPM)
install(TARGETS mappm mappm-reference)
install(TARGETS mappm_flags mappm_physics mappm_particles mappm_scene mappm_serial mappm_output_serial mappm_library
  EXPORT MaPPMTargets)
install(TARGETS mappm_domains mappm_parallel mappm_output_parallel EXPORT MaPPMParallelTargets)
# mappm_library is MaPPM::mappm, the target that most programs want.
set_target_properties(mappm_library PROPERTIES EXPORT_NAME mappm)
set_target_properties(mappm_flags PROPERTIES EXPORT_NAME flags)
install(EXPORT MaPPMTargets NAMESPACE MaPPM:: DESTINATION ${package_folder})
install(EXPORT MaPPMParallelTargets NAMESPACE MaPPM:: DESTINATION ${package_folder})

# Of the scene only what shows no TOML, of the output what shows no HDF5: their libraries are known to sources alone.
foreach(layer base physics particles serial parallel output library)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/solver/${layer} DESTINATION ${MAPPM_INSTALL_HEADERS} FILES_MATCHING
    PATTERN "*.hpp" PATTERN "hdf5_file.hpp" EXCLUDE)
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/solver/scene DESTINATION ${MAPPM_INSTALL_HEADERS} FILES_MATCHING
  REGEX "/(scene|reader|build)\\.hpp$")

include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/MaPPMConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_BINARY_DIR}/MaPPMConfigVersion.cmake ${CMAKE_SOURCE_DIR}/cmake/MaPPMConfig.cmake
  ${CMAKE_SOURCE_DIR}/cmake/FindHDF5Flavours.cmake DESTINATION ${package_folder})
