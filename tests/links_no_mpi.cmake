# Script: fails where PROGRAM is linked, directly or not, to an MPI library.
execute_process(COMMAND ldd ${PROGRAM} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(NOT libraries MATCHES "libc\\.so")
  message(FATAL_ERROR "ldd names no library of ${PROGRAM}:\n${libraries}")
endif()
if(libraries MATCHES "libmpi|libopen-(rte|pal)")
  message(FATAL_ERROR "${PROGRAM} is linked to MPI:\n${libraries}")
endif()
