# Script: writes OUTPUT from SOURCE_DIR, COMPILER, FLAGS, PORTABLE and VERSION.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
string(CONFIGURE [[// Written by the build: where this program comes from.
#pragma once

namespace mappm::build_info {

inline constexpr const char* version = "@VERSION@";
inline constexpr const char* commit = "@commit@";
inline constexpr const char* compiler = "@COMPILER@";
inline constexpr const char* flags = "@FLAGS@";
inline constexpr bool portable = @PORTABLE@;  // mappm chooses among instruction sets

}  // namespace mappm::build_info
]] text @ONLY)
set(previous "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} previous)
endif()
if(NOT previous STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
