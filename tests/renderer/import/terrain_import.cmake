# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_test_terrain terrain_fixture.cpp)
target_link_libraries(eyrie_test_terrain PUBLIC eyrie::terrain_import eyrie_test_grids GTest::gtest)

eyrie_test(terrain_bound_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_seam_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_normals_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_nodata_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(lone_posts_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_outline_test LABEL unit LINK eyrie_test_terrain eyrie::truth)
eyrie_test(eyt_damage_test LABEL unit MEMORY LINK eyrie_test_terrain)
eyrie_test(terrain_import_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(raster_name_test LABEL unit LINK eyrie::terrain_import)
eyrie_test(dem_source_test LABEL unit LINK eyrie_test_terrain eyrie::test_support GDAL::GDAL fmt::fmt)
eyrie_test(tile_bytes_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(dem_mosaic_test LABEL unit
           SOURCES degrees_caveat_test.cpp dem_blocks_test.cpp dem_mosaic_fixture.cpp dem_mosaic_test.cpp dem_tiles_test.cpp dem_units_test.cpp length_caveat_test.cpp wide_lands_test.cpp
           LINK eyrie_test_terrain GDAL::GDAL fmt::fmt)
eyrie_test(terrain_resume_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(import_locks_test LABEL unit LINK eyrie_test_terrain)
add_library(eyrie_test_imagery imagery_fixture.cpp)
target_link_libraries(eyrie_test_imagery PUBLIC eyrie_test_terrain PRIVATE GDAL::GDAL)
eyrie_test(imagery_import_test LABEL unit
           SOURCES imagery_formats_test.cpp imagery_import_test.cpp imagery_places_test.cpp imagery_strips_test.cpp imagery_whole_test.cpp
           LINK eyrie_test_imagery GDAL::GDAL fmt::fmt)
eyrie_test(terrain_kill_test LABEL unit LINK eyrie_test_imagery fmt::fmt)
eyrie_test(file_hash_test LABEL unit LINK eyrie_test_terrain eyrie::test_support)
eyrie_test(shard_plan_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(whole_file_test LABEL unit LINK eyrie_test_terrain)
eyrie_test(terrain_shard_test LABEL unit LINK eyrie_test_imagery)
# These measure at every point of whole terrains: slow where they are not optimised.
set_source_files_properties(terrain_bound_test.cpp terrain_seam_test.cpp PROPERTIES COMPILE_OPTIONS -O1 SKIP_PRECOMPILE_HEADERS ON)
