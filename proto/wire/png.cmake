# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_png pixel_deflate.cpp png.cpp prefix_code.cpp)
add_library(eyrie::png ALIAS eyrie_png)
target_link_libraries(eyrie_png PUBLIC eyrie::fabric absl::statusor PRIVATE PkgConfig::DEFLATE fmt::fmt)
# Each pixel of an exact picture passes here; -O2 of g++ 12 leaves it scalar.
set_source_files_properties(pixel_deflate.cpp png.cpp PROPERTIES COMPILE_OPTIONS -O3)
