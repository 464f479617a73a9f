# Targets `tidy` and `format`: clang-tidy over the sources of this build, clang-format in place; `format-check` changes nothing.
find_program(CLANG_TIDY NAMES clang-tidy-14 clang-tidy)
find_program(RUN_CLANG_TIDY NAMES run-clang-tidy-14 run-clang-tidy)
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/solver/*.[ch]pp ${CMAKE_SOURCE_DIR}/tests/*.[ch]pp
  ${CMAKE_SOURCE_DIR}/bench/*.[ch]pp)
if(RUN_CLANG_TIDY AND CLANG_TIDY)
  add_custom_target(tidy COMMAND ${RUN_CLANG_TIDY} -quiet -clang-tidy-binary ${CLANG_TIDY} -p ${CMAKE_BINARY_DIR}
    "${CMAKE_SOURCE_DIR}/solver/.*" WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} VERBATIM)
endif()
if(CLANG_FORMAT)
  add_custom_target(format COMMAND ${CLANG_FORMAT} -i ${sources})
  add_custom_target(format-check COMMAND ${CLANG_FORMAT} --dry-run --Werror ${sources})
endif()
