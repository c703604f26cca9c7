# SPDX-License-Identifier: Apache-2.0
# eyrie::build_flags carries the language, the warnings and the sanitizer of every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

find_program(CCACHE ccache)
if(CCACHE)
    # Precompiled headers are told apart by their contents, and no file here asks for the time.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_INODECACHE=1
        CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

add_library(eyrie_build_flags INTERFACE)
add_library(eyrie::build_flags ALIAS eyrie_build_flags)
target_compile_options(eyrie_build_flags INTERFACE -Wall -Wextra -Wshadow -Wconversion)
# A fused multiply-add rounds once where a product and a sum round twice: never let the compiler
# choose, so that every build and every machine computes the same vertex.
target_compile_options(eyrie_build_flags INTERFACE -ffp-contract=off)
target_include_directories(eyrie_build_flags INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/proto)
target_link_options(eyrie_build_flags INTERFACE -fuse-ld=lld)
if(EYRIE_WARNINGS_ARE_ERRORS)
    target_compile_options(eyrie_build_flags INTERFACE -Werror)
endif()
if(EYRIE_SANITIZE)
    target_compile_options(eyrie_build_flags INTERFACE -fsanitize=${EYRIE_SANITIZE} -fno-omit-frame-pointer)
    # GCC documents it as unreliable in instrumented code; plain builds have it.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(eyrie_build_flags INTERFACE -Wno-maybe-uninitialized)
    endif()
    target_link_options(eyrie_build_flags INTERFACE -fsanitize=${EYRIE_SANITIZE})
    # Where tests run, the address sanitizer stops for what the first three would have told, and x86
    # does not mind alignment: together they are two fifths of the time that compiling takes. Fuzz
    # targets, which read bytes as they come, have them all.
    if(EYRIE_SANITIZE MATCHES "^address,undefined$")
        target_compile_options(eyrie_build_flags INTERFACE -fno-sanitize=null,object-size,vptr,alignment)
    endif()
endif()
