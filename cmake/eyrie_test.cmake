# SPDX-License-Identifier: Apache-2.0
# eyrie_test(NAME LABEL unit|integration|golden|browser [MEMORY] [SOURCES ...] LINK targets...)
# builds NAME from NAME.cpp (or SOURCES) and registers it with CTest under LABEL. MEMORY: some of it
# measures or limits memory, which holds in builds without sanitizers alone.
if(EYRIE_BUILD_TESTS)
    find_package(GTest REQUIRED)
    find_path(RAPIDCHECK_INCLUDE_DIR rapidcheck.h REQUIRED)
    find_library(RAPIDCHECK_LIBRARY rapidcheck REQUIRED)
    add_library(eyrie_rapidcheck INTERFACE)
    add_library(eyrie::rapidcheck ALIAS eyrie_rapidcheck)
    target_include_directories(eyrie_rapidcheck SYSTEM INTERFACE ${RAPIDCHECK_INCLUDE_DIR})
    target_link_libraries(eyrie_rapidcheck INTERFACE ${RAPIDCHECK_LIBRARY})

    add_library(eyrie_test_flags INTERFACE)
    add_library(eyrie::test_flags ALIAS eyrie_test_flags)
    target_link_libraries(eyrie_test_flags INTERFACE eyrie::build_flags eyrie::rapidcheck
                                                     GTest::gmock GTest::gtest)
    # A test's own source is compiled for longer than it runs.
    target_compile_options(eyrie_test_flags INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)

    eyrie_add_headers(eyrie_test_headers <gmock/gmock.h> <gtest/gtest.h> <rapidcheck/gtest.h>)
    target_link_libraries(eyrie_test_headers PRIVATE eyrie::test_flags)
endif()

function(eyrie_test NAME)
    cmake_parse_arguments(ARG "MEMORY" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
    if(NOT ARG_SOURCES)
        set(ARG_SOURCES ${NAME}.cpp)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_executable(${NAME} ${ARG_SOURCES})
    target_link_libraries(${NAME} PRIVATE ${ARG_LINK} eyrie::test_flags GTest::gtest_main)
    target_precompile_headers(${NAME} REUSE_FROM eyrie_test_headers)
    target_compile_definitions(${NAME} PRIVATE EYRIE_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                               EYRIE_BINARY="${CMAKE_BINARY_DIR}/bin/eyrie")
    set_target_properties(${NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    if(ARG_MEMORY)
        list(APPEND ARG_LABEL memory)
    endif()
    if(ARG_LABEL STREQUAL "unit" AND NOT EYRIE_BUILD_UNIT_TESTS)
        set_target_properties(${NAME} PROPERTIES EXCLUDE_FROM_ALL ON)
        return()
    endif()
    add_test(NAME ${NAME} COMMAND ${NAME})
    set_tests_properties(${NAME} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
