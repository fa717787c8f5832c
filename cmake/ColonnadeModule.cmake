# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause

# Warnings and instrumentation of our own code. Third-party headers are SYSTEM.
add_library(colonnade_flags INTERFACE)
target_compile_options(colonnade_flags INTERFACE -Wall -Wextra -Wconversion -Werror)
# Same log, same bytes: no contraction of a*b+c that differs between compilers' choices.
target_compile_options(colonnade_flags INTERFACE -ffp-contract=off)
if(COLONNADE_SANITIZE)
  target_compile_options(colonnade_flags INTERFACE -fsanitize=${COLONNADE_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(colonnade_flags INTERFACE -fsanitize=${COLONNADE_SANITIZE})
endif()
if(COLONNADE_COVERAGE)
  target_compile_options(colonnade_flags INTERFACE --coverage)
  target_link_options(colonnade_flags INTERFACE --coverage)
endif()

# colonnade_module(NAME SOURCES a.cpp ... PUBLIC_LINKS ... PRIVATE_LINKS ... PUBLIC_SYSTEM_INCLUDES ...)
# One target per module. What a module may include is what it links.
function(colonnade_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC_LINKS;PRIVATE_LINKS;PUBLIC_SYSTEM_INCLUDES" ${ARGN})
  add_library(colonnade_${name} STATIC ${ARG_SOURCES})
  add_library(colonnade::${name} ALIAS colonnade_${name})
  target_include_directories(colonnade_${name} PUBLIC include)
  target_include_directories(colonnade_${name} SYSTEM PUBLIC ${ARG_PUBLIC_SYSTEM_INCLUDES})
  target_link_libraries(colonnade_${name}
    PUBLIC ${ARG_PUBLIC_LINKS}
    PRIVATE ${ARG_PRIVATE_LINKS} $<BUILD_INTERFACE:colonnade_flags>)
endfunction()

# colonnade_test(NAME SOURCES a_test.cpp ... LINKS ...): one test program per module.
function(colonnade_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  target_link_libraries(test_${name} PRIVATE ${ARG_LINKS} colonnade_flags GTest::gmock_main)
  target_compile_definitions(test_${name} PRIVATE
    COLONNADE_SOURCE="${PROJECT_SOURCE_DIR}"
    COLONNADE_PROGRAM="$<TARGET_FILE:colonnade_program>")
  add_dependencies(test_${name} colonnade_program)
  gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
