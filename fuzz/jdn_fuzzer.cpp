// SPDX-License-Identifier: Apache-2.0
// .jdn scenes of any bytes: a mesh that keeps TriangleMesh's invariant, or a message.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "renderer/import/jdn_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::import;
    const auto mesh = parseJdn({reinterpret_cast<const char*>(data), size}, "fuzzed.jdn");
    if (!mesh.ok())
        return 0;
    const std::size_t count = mesh->positions.size();
    if ((!mesh->normals.empty() && mesh->normals.size() != count) ||
        (!mesh->colours.empty() && mesh->colours.size() != count))
        std::abort();
    for (const auto& triangle : mesh->triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= count)
                std::abort();
    return 0;
}
