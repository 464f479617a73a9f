# mappm_layer(NAME SOURCES file... [PUBLIC target...] [PRIVATE target...] [INSIDE target...])
# A library of one layer, mappm_LAYER; once installed MaPPM::LAYER. Its sources include headers as "layer/file.hpp".
# INSIDE: libraries of headers alone that no header of the layer includes, so that an installed one does not need them.
function(mappm_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "" "SOURCES;PUBLIC;PRIVATE;INSIDE")
  list(TRANSFORM layer_INSIDE REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  add_library(${name} STATIC ${layer_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/solver>
    $<INSTALL_INTERFACE:${MAPPM_INSTALL_HEADERS}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${name} PUBLIC mappm_flags $<BUILD_INTERFACE:mappm_build_flags> ${layer_PUBLIC}
    PRIVATE ${layer_PRIVATE} ${layer_INSIDE})
  string(REPLACE mappm_ "" export_name ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${export_name})
endfunction()
