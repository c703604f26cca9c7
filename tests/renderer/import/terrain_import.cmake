# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_test_terrain terrain_fixture.cpp)
target_link_libraries(eyrie_test_terrain PUBLIC eyrie::terrain_import eyrie_test_grids GTest::gtest)

eyrie_test(terrain_bound_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_seam_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_normals_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_nodata_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(eyt_damage_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_import_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(dem_source_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(tile_bytes_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(dem_mosaic_test LABEL unit LINK eyrie_test_terrain GDAL::GDAL fmt::fmt)
eyrie_test(terrain_resume_test LABEL unit LINK eyrie_test_terrain)
