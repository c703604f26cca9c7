// SPDX-License-Identifier: Apache-2.0
// PLY files of any bytes: refused, or a mesh that keeps TriangleMesh's invariant and can be packed.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/ply_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::import;
    auto mesh = parsePly({reinterpret_cast<const char*>(data), size}, "fuzzed.ply");
    if (!mesh.ok())
        return 0;
    const std::size_t count = mesh->positions.size();
    if ((!mesh->colours.empty() && mesh->colours.size() != count) ||
        mesh->textureCoordinates.size() != mesh->materialOf.size() ||
        (!mesh->materialOf.empty() && mesh->materialOf.size() != count))
        std::abort();
    for (const auto& triangle : mesh->triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= count || (!mesh->materialOf.empty() &&
                                    (mesh->materialOf[corner] >= mesh->materials.size() ||
                                     mesh->materialOf[corner] != mesh->materialOf[triangle[0]])))
                std::abort();
    mesh->images.resize(mesh->textures.size());  // as if they had been loaded
    PackCounts counts;
    static_cast<void>(packMesh(*std::move(mesh), counts));
    return 0;
}
