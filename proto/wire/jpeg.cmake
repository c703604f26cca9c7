# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_jpeg jpeg.cpp jpeg_halves.cpp)
add_library(eyrie::jpeg ALIAS eyrie_jpeg)
target_link_libraries(eyrie_jpeg PUBLIC eyrie::fabric absl::statusor
                                 PRIVATE PkgConfig::TURBOJPEG fmt::fmt)
