# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_terrain_import colour_file.cpp colour_warp.cpp crs_text.cpp degrees_caveat.cpp dem_file.cpp dem_mosaic.cpp dem_order.cpp dem_source.cpp dem_warp.cpp elevation_reading.cpp file_hash.cpp
                                 gdal_handles.cpp geotiff_writer.cpp imagery_pages.cpp imagery_source.cpp import_journal.cpp joined_dems.cpp layer_reader.cpp layered_dems.cpp length_caveat.cpp
                                 local_projection.cpp lone_posts.cpp page_line.cpp part_set.cpp picture_fingerprint.cpp raster_file.cpp raster_hash.cpp raster_name.cpp rimmed_dem.cpp shard_facts.cpp shard_part.cpp shard_plan.cpp strip_order.cpp
                                 terrain_choices.cpp terrain_import.cpp terrain_shard.cpp terrain_stages.cpp terrain_synth.cpp
                                 texel_store.cpp whole_decoding.cpp whole_file.cpp written_levels.cpp)
add_library(eyrie::terrain_import ALIAS eyrie_terrain_import)
target_link_libraries(eyrie_terrain_import PUBLIC eyrie::fabric eyrie::terrain PRIVATE GDAL::GDAL fmt::fmt PkgConfig::XXHASH TBB::tbb)
# The noise loops: -O2 of g++ 12 leaves them scalar.
set_source_files_properties(terrain_synth.cpp PROPERTIES COMPILE_OPTIONS "-O3;-fopenmp-simd")
