# SPDX-License-Identifier: Apache-2.0
# What nearly every file includes is compiled once: eyrie_headers for libraries and programs,
# eyrie_test_headers for tests, which are optimised otherwise. Only other projects' headers are in
# them. The preset `debug` goes without, so that each file includes what it uses.

# Macros that these headers see are the same everywhere; gRPC and GoogleTest bring -pthread.
target_link_libraries(eyrie_build_flags INTERFACE absl::statusor fmt::fmt eyrie::glm Threads::Threads)
target_compile_options(eyrie_build_flags INTERFACE -pthread)

function(eyrie_add_headers NAME)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${NAME}.cpp CONTENT "" @ONLY)
    add_library(${NAME} OBJECT ${CMAKE_BINARY_DIR}/generated/${NAME}.cpp)
    target_link_libraries(${NAME} PRIVATE eyrie::build_flags)
    target_precompile_headers(${NAME} PRIVATE
        <absl/status/statusor.h> <fmt/format.h>
        <algorithm> <array> <cmath> <functional> <memory> <mutex> <optional> <span>
        <string> <thread> <utility> <vector>
        <glm/geometric.hpp> <glm/mat4x4.hpp> <glm/vec3.hpp> ${ARGN})
endfunction()

# eyrie_use_headers(DIRECTORY): every library and program in DIRECTORY and below, once all are known;
# but not sources with options of their own, for which headers would have to be compiled otherwise.
function(eyrie_use_headers DIRECTORY)
    get_property(targets DIRECTORY ${DIRECTORY} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
        get_target_property(type ${target} TYPE)
        if(type MATCHES "STATIC_LIBRARY|EXECUTABLE")
            target_precompile_headers(${target} REUSE_FROM eyrie_headers)
            get_target_property(sources ${target} SOURCES)
            get_target_property(folder ${target} SOURCE_DIR)
            foreach(source IN LISTS sources)
                cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder})
                get_source_file_property(options ${source} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
                if(options)
                    set_source_files_properties(${source} TARGET_DIRECTORY ${target}
                                                PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
                endif()
            endforeach()
        endif()
    endforeach()
    get_property(folders DIRECTORY ${DIRECTORY} PROPERTY SUBDIRECTORIES)
    foreach(folder IN LISTS folders)
        eyrie_use_headers(${folder})
    endforeach()
endfunction()
