# SPDX-License-Identifier: Apache-2.0
# eyrie_effects(TARGET EFFECTS FILES... [BLOCKS FILES...]) compiles effect files to typed C++:
# mesh.effect to "effects/mesh_effect.h", object.block to "effects/object_block.h", for TARGET and
# all that link it. Every variant of every effect passes glslangValidator, or the build fails; only
# builds with sanitizers leave that to the others.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

set(EYRIE_EFFECT_CHECK ${GLSLANG_VALIDATOR})
if(EYRIE_SANITIZE)
    set(EYRIE_EFFECT_CHECK "")
endif()

function(eyrie_effects TARGET)
    cmake_parse_arguments(ARG "" "" "EFFECTS;BLOCKS" ${ARGN})
    set(generated ${CMAKE_BINARY_DIR}/generated)
    foreach(file ${ARG_EFFECTS} ${ARG_BLOCKS})
        string(REPLACE . _ name ${file})
        set(header ${generated}/effects/${name}.h)
        add_custom_command(
            OUTPUT ${header}
            COMMAND effect_compiler ${CMAKE_CURRENT_SOURCE_DIR}/${file} ${header} ${EYRIE_EFFECT_CHECK}
            DEPENDS effect_compiler ${CMAKE_CURRENT_SOURCE_DIR}/${file}
            DEPFILE ${header}.d
            COMMENT "Compiling effect ${file}"
            VERBATIM)
        target_sources(${TARGET} PRIVATE ${header})
    endforeach()
    target_include_directories(${TARGET} PUBLIC ${generated})
endfunction()
