// SPDX-License-Identifier: Apache-2.0
// glTF of any bytes: a .glb in which nothing is left to unpack, or a message; what it asks of its
// readers, in messages that can be printed.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "access/printable.h"
#include "renderer/import/gltf_extensions.h"
#include "renderer/import/gltf_unpacking.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie;
    using namespace eyrie::import;
    const auto bytes = std::as_bytes(std::span(data, size));
    if (const auto required = checkGltfExtensions(bytes); !required.ok()) {
        const std::string message(required.message());
        if (message != access::printableUtf8(message))
            std::abort();
    }
    static_cast<void>(gltfCaveats(bytes));
    std::vector<std::string> notes;
    const auto glb = unpackGltf(bytes, "fuzzed.gltf", notes);
    if (!glb.ok() || !*glb)
        return 0;
    const auto again = unpackGltf(std::as_bytes(std::span(**glb)), "fuzzed.gltf", notes);
    if (!again.ok() || (*again && *again != *glb))
        std::abort();
    return 0;
}
