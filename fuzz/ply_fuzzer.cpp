// SPDX-License-Identifier: Apache-2.0
// PLY files of any bytes: refused, or a mesh that can be packed.
#include <cstdint>
#include <string_view>
#include <utility>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/ply_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::import;
    auto mesh = parsePly({reinterpret_cast<const char*>(data), size}, "fuzzed.ply");
    PackCounts counts;
    if (mesh.ok())
        static_cast<void>(packMesh(*std::move(mesh), counts));
    return 0;
}
