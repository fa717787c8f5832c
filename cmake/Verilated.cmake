# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause

# colonnade_verilate(NAME PARAMETER=VALUE ...): the library rtl_NAME with the class VNAME, the
# accelerator with these parameters. Generated code: our warnings do not apply.
file(STRINGS ${PROJECT_SOURCE_DIR}/hdl/rtl/files.f COLONNADE_RTL_FILES REGEX "^[^/]")
list(TRANSFORM COLONNADE_RTL_FILES PREPEND ${PROJECT_SOURCE_DIR}/hdl/rtl/)
file(WRITE ${PROJECT_BINARY_DIR}/verilated_empty.cpp "")
function(colonnade_verilate name)
  list(TRANSFORM ARGN PREPEND -G OUTPUT_VARIABLE parameters)
  add_library(rtl_${name} STATIC ${PROJECT_BINARY_DIR}/verilated_empty.cpp)
  set_target_properties(rtl_${name} PROPERTIES SYSTEM ON)
  verilate(rtl_${name} PREFIX V${name} TOP_MODULE accelerator
    SOURCES ${PROJECT_SOURCE_DIR}/hdl/lint/waivers.vlt ${COLONNADE_RTL_FILES}
    VERILATOR_ARGS -Wall -O3 --x-assign fast --x-initial fast --noassert ${parameters}
    OPT_FAST -O1 OPT_SLOW -O0 OPT_GLOBAL -O1)
endfunction()
