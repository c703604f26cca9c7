// SPDX-License-Identifier: Apache-2.0
// .jdn scenes of any bytes: refused, or a mesh that keeps TriangleMesh's invariant and can be
// packed.
#include <cstdint>
#include <string_view>

#include "fuzz/check_mesh.h"
#include "renderer/import/jdn_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::import;
    auto mesh = parseJdn({reinterpret_cast<const char*>(data), size}, "fuzzed.jdn");
    if (mesh.ok())
        checkMesh(*std::move(mesh));
    return 0;
}
