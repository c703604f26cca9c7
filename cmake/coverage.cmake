# SPDX-License-Identifier: Apache-2.0
# With EYRIE_COVERAGE the project's own libraries count which of their lines are run;
# tools/coverage.py tells. Neither tests nor generated code count, so that it costs little to compile
# and run. Counters are plain ones (with -pthread GCC's own choice is atomic ones): threads may lose
# some of each other's counts, but what counts is whether a line was run.

set(plain_counters -fprofile-update=single)
if(CCACHE)
    # Which gives up on options that it does not know.
    set(plain_counters --ccache-skip -fprofile-update=single)
endif()

# eyrie_count_lines(FOLDERS...): the libraries of these folders and below, once all are known.
function(eyrie_count_lines)
    foreach(folder IN LISTS ARGN)
        get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
        foreach(target IN LISTS targets)
            get_target_property(type ${target} TYPE)
            if(type STREQUAL "STATIC_LIBRARY")
                target_compile_options(${target} PRIVATE --coverage ${plain_counters})
                target_link_options(${target} INTERFACE --coverage)
            endif()
        endforeach()
        get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
        eyrie_count_lines(${below})
    endforeach()
endfunction()
