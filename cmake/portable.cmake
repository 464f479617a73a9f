# mappm_portable(NAME DISPATCHER file MAIN file LAYERS target... SHARED target...)
# A program that holds MAIN and LAYERS once for each instruction set, SHARED once for the baseline, and DISPATCHER, which
# calls one main.
#
# Code for one set must never be reached from elsewhere. Of a template or an inline function that several files define
# the linker keeps one, whatever it was compiled for. So each set is first linked by itself into one object, whose only
# global symbol is its main, as main_SET; what it does not hold itself is compiled for the baseline, or is a library.
# The pointers to its static initialisers leave .init_array, all of which is called at start, for a section init_SET: the
# dispatcher calls those of the set it chose.
set(MAPPM_INSTRUCTION_SETS plain avx2 avx512)  # as in app/instruction_set.hpp
set(MAPPM_ARCHITECTURES x86-64 x86-64-v3 x86-64-v4)

function(mappm_portable name)
  cmake_parse_arguments(PARSE_ARGV 1 portable "" "DISPATCHER;MAIN" "LAYERS;SHARED")
  set(sources ${portable_MAIN})
  set(libraries "")
  foreach(layer IN LISTS portable_LAYERS)
    get_target_property(layer_sources ${layer} SOURCES)
    get_target_property(layer_libraries ${layer} LINK_LIBRARIES)
    list(APPEND sources ${layer_sources})
    list(APPEND libraries ${layer_libraries})
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  list(REMOVE_ITEM libraries ${portable_LAYERS})
  list(APPEND libraries ${portable_SHARED})

  foreach(set architecture IN ZIP_LISTS MAPPM_INSTRUCTION_SETS MAPPM_ARCHITECTURES)
    add_library(${name}_${set} OBJECT ${sources})
    target_include_directories(${name}_${set} PRIVATE ${CMAKE_SOURCE_DIR}/solver)
    target_compile_options(${name}_${set} PRIVATE -march=${architecture} -fno-gnu-unique)
    target_link_libraries(${name}_${set} PRIVATE ${libraries})
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}_${set}.o)
    add_custom_command(OUTPUT ${object} DEPENDS $<TARGET_OBJECTS:${name}_${set}>
      COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object} $<TARGET_OBJECTS:${name}_${set}>
      COMMAND ${CMAKE_OBJCOPY} --redefine-sym main=main_${set} --keep-global-symbol main_${set}
        --rename-section .init_array=init_${set} ${object}
      COMMENT "Linking ${name} for ${architecture}" COMMAND_EXPAND_LISTS VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  add_executable(${name} ${portable_DISPATCHER} ${objects})
  target_link_libraries(${name} PRIVATE ${libraries})
endfunction()
