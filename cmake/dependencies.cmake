# SPDX-License-Identifier: Apache-2.0
# Everything comes from Debian 12; `./dev deps` installs it.
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(absl REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Protobuf REQUIRED)
find_package(gRPC CONFIG REQUIRED)
find_package(GDAL CONFIG REQUIRED)
find_package(TBB CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(assimp CONFIG REQUIRED)
find_package(meshoptimizer CONFIG REQUIRED)  # what bench/page_codec compares with, as zstd
find_package(Boost REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(GLEW REQUIRED IMPORTED_TARGET glew)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LIBAV IMPORTED_TARGET libavcodec libavformat libavutil)  # optional: video/

find_path(PEGTL_INCLUDE_DIR tao/pegtl.hpp REQUIRED)
add_library(eyrie_pegtl INTERFACE)
add_library(eyrie::pegtl ALIAS eyrie_pegtl)
target_include_directories(eyrie_pegtl SYSTEM INTERFACE ${PEGTL_INCLUDE_DIR})

find_path(GLM_INCLUDE_DIR glm/glm.hpp REQUIRED)
add_library(eyrie_glm INTERFACE)
add_library(eyrie::glm ALIAS eyrie_glm)
target_include_directories(eyrie_glm SYSTEM INTERFACE ${GLM_INCLUDE_DIR})
target_compile_definitions(eyrie_glm INTERFACE GLM_FORCE_EXPLICIT_CTOR)

find_path(STB_INCLUDE_DIR stb/stb_dxt.h REQUIRED)
add_library(eyrie_stb INTERFACE)
add_library(eyrie::stb ALIAS eyrie_stb)
target_include_directories(eyrie_stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})
