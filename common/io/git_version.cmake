# Run at every build: writes the header OUTPUT with the commit of SOURCE_DIR; touches it only if that has changed.
cmake_minimum_required(VERSION 3.25)
execute_process(
  COMMAND git describe --always --dirty --abbrev=12 --match=NONE
  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE version RESULT_VARIABLE result
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT result EQUAL 0 OR version STREQUAL "")
  set(version "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#pragma once\nnamespace common {\ninline constexpr char kGitVersion[] = \"@version@\";\n}\n" @ONLY)
