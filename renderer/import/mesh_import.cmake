# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_mesh_import amf_text.cpp amf_volumes.cpp assimp_axes.cpp assimp_caveats.cpp assimp_colours.cpp assimp_files.cpp assimp_formats.cpp assimp_lights.cpp assimp_log.cpp assimp_materials.cpp assimp_meshes.cpp assimp_reader.cpp assimp_rounding.cpp collada_text.cpp companion_folder.cpp duplicate_faces.cpp dxf_colours.cpp dxf_text.cpp gltf_buffers.cpp gltf_chunks.cpp gltf_extensions.cpp gltf_mending.cpp gltf_unpacking.cpp jdn_lights.cpp jdn_materials.cpp jdn_reader.cpp joined_meshes.cpp jpeg_end.cpp
                              mesh_backs.cpp mesh_import.cpp mesh_import_parts.cpp mesh_part.cpp mesh_reader.cpp
                              mesh_sharing.cpp mesh_split.cpp mesh_spool.cpp
                              mesh_synth.cpp named_images.cpp normals.cpp obj_materials.cpp obj_text.cpp obj_textures.cpp off_text.cpp orient.cpp pack_mesh.cpp part_mesh.cpp
                              ply_faces.cpp ply_header.cpp ply_layout.cpp ply_reader.cpp ply_textures.cpp ply_values.cpp
                              ply_vertices.cpp ply_writer.cpp polygon.cpp reading_process.cpp sgi_image.cpp source_lights.cpp stated_unit.cpp stl_colours.cpp stl_length.cpp stl_text.cpp texture_files.cpp three_mf.cpp uri_name.cpp weld.cpp x3d_caveats.cpp x3d_text.cpp xml_tag.cpp zip_parts.cpp)
add_library(eyrie::mesh_import ALIAS eyrie_mesh_import)
target_link_libraries(eyrie_mesh_import PUBLIC eyrie::fabric eyrie::mesh
                                        PRIVATE assimp::assimp meshoptimizer::meshoptimizer nlohmann_json::nlohmann_json eyrie::access eyrie::stb fmt::fmt PkgConfig::MINIZIP TBB::tbb)
