# SPDX-License-Identifier: Apache-2.0
# eyrie_test(NAME LABEL unit|integration|golden|browser [SOURCES ...] LINK targets...)
# builds NAME from NAME.cpp (or SOURCES) and registers it with CTest under LABEL.
if(EYRIE_BUILD_TESTS)
    find_package(GTest REQUIRED)
    find_path(RAPIDCHECK_INCLUDE_DIR rapidcheck.h REQUIRED)
    find_library(RAPIDCHECK_LIBRARY rapidcheck REQUIRED)
    add_library(eyrie_rapidcheck INTERFACE)
    add_library(eyrie::rapidcheck ALIAS eyrie_rapidcheck)
    target_include_directories(eyrie_rapidcheck SYSTEM INTERFACE ${RAPIDCHECK_INCLUDE_DIR})
    target_link_libraries(eyrie_rapidcheck INTERFACE ${RAPIDCHECK_LIBRARY})
endif()

function(eyrie_test NAME)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
    if(NOT ARG_SOURCES)
        set(ARG_SOURCES ${NAME}.cpp)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_executable(${NAME} ${ARG_SOURCES})
    target_link_libraries(${NAME} PRIVATE ${ARG_LINK} eyrie::build_flags eyrie::rapidcheck
                                          GTest::gmock GTest::gtest GTest::gtest_main)
    # A test's own source is compiled for longer than it runs.
    target_compile_options(${NAME} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)
    target_compile_definitions(${NAME} PRIVATE EYRIE_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                               EYRIE_BINARY="${CMAKE_BINARY_DIR}/bin/eyrie")
    set_target_properties(${NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    add_test(NAME ${NAME} COMMAND ${NAME})
    set_tests_properties(${NAME} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()
