# SPDX-License-Identifier: Apache-2.0
# With EYRIE_COVERAGE the libraries of the core logic (CONTRIBUTING.md) count which of their lines
# are run; tools/coverage.py tells. Nothing else counts, so that it costs little to compile and run.

# eyrie_count_lines(FOLDERS...): the libraries of these folders and below, once all are known.
function(eyrie_count_lines)
    foreach(folder IN LISTS ARGN)
        get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
        foreach(target IN LISTS targets)
            get_target_property(type ${target} TYPE)
            if(type STREQUAL "STATIC_LIBRARY")
                target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
                target_link_options(${target} INTERFACE --coverage)
            endif()
        endforeach()
        get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
        eyrie_count_lines(${below})
    endforeach()
endfunction()
