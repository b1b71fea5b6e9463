# SPDX-License-Identifier: BSD-3-Clause
# Run at every build: writes OUTPUT, a source file with the version, if it has changed. Without git, the version alone.
set(version "${VERSION}")
execute_process(COMMAND git describe --always --dirty --match ""
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(revision)
  string(APPEND version " (${revision})")
endif()
set(text "#include \"base/record/installation.hpp\"\n
std::string isostat::version() { return \"${version}\"; }\n")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUTPUT} "${text}")
endif()
