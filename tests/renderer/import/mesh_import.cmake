# SPDX-License-Identifier: Apache-2.0
eyrie_test(ply_values_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(ply_reader_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(ply_damage_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(ply_files_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(polygon_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(weld_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(pack_mesh_test LABEL unit LINK eyrie::mesh_import TBB::tbb)
eyrie_test(mesh_import_test LABEL unit
           SOURCES mesh_edges_test.cpp mesh_import_test.cpp mesh_memory_test.cpp mesh_parts_test.cpp
                   mesh_precision_test.cpp
           LINK eyrie::mesh_import TBB::tbb)
eyrie_test(mesh_synth_test LABEL unit LINK eyrie::mesh_import TBB::tbb)
eyrie_test(reading_process_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(assimp_formats_test LABEL unit LINK eyrie::mesh_import assimp::assimp)
eyrie_test(assimp_reader_test LABEL unit
           SOURCES assimp_amf_test.cpp assimp_collada_test.cpp assimp_gltf_test.cpp
                   assimp_lights_test.cpp assimp_obj_test.cpp assimp_reader_test.cpp
                   assimp_rounding_test.cpp assimp_stl_test.cpp assimp_textures_test.cpp assimp_x3d_test.cpp
           LINK eyrie::mesh_import assimp::assimp)
eyrie_test(companion_folder_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(dxf_text_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(gltf_extensions_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(jdn_reader_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(named_images_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(source_lights_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(stated_unit_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(gltf_unpacking_test LABEL unit LINK eyrie::mesh_import meshoptimizer::meshoptimizer)
eyrie_test(joined_meshes_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(mesh_reader_test LABEL unit MEMORY LINK eyrie::mesh_import)
eyrie_test(mesh_images_test LABEL unit LINK eyrie::mesh_import eyrie::stb)
eyrie_test(mesh_source_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(obj_materials_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(off_text_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(orient_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(three_mf_test LABEL unit LINK eyrie::mesh_import PkgConfig::MINIZIP)
eyrie_test(texture_places_test LABEL unit LINK eyrie::mesh_import assimp::assimp)
eyrie_test(mesh_files_test LABEL unit LINK eyrie::mesh_import)
eyrie_test(bad_mesh_test LABEL unit LINK eyrie::mesh_import)
