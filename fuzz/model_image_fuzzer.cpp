// SPDX-License-Identifier: Apache-2.0
// Pictures on models, of any bytes: in Silicon Graphics' format refused, or as many texels as their
// sides say; of JPEGs where they end. All else of pictures is read by stb, in a process of its own.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "renderer/import/jpeg_end.h"
#include "renderer/import/sgi_image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie;
    const auto bytes = std::as_bytes(std::span(data, size));
    static_cast<void>(import::looksLikeSgi(bytes));
    mesh::ImageShape shape;
    const auto texels = import::decodeSgi(bytes, shape);
    if (texels.ok() ? texels->size() != std::size_t{shape.width} * shape.height
                    : texels.status().code() != absl::StatusCode::kInvalidArgument)
        std::abort();
    static_cast<void>(import::isOneJpegScan(bytes));
    static_cast<void>(import::lacksJpegEnd(bytes));
    if (import::lacksJpegEnd(import::withJpegEnd(bytes, "\xFF\xDA")))  // a scan, and its end
        std::abort();
    return 0;
}
