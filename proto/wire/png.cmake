# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_png png.cpp)
add_library(eyrie::png ALIAS eyrie_png)
target_link_libraries(eyrie_png PUBLIC eyrie::fabric absl::statusor PRIVATE PkgConfig::DEFLATE fmt::fmt)
