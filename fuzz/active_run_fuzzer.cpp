// SPDX-License-Identifier: Apache-2.0
// Bands of any bytes. The first four say how large the picture is and whether it has depth; a fifth
// whether the rest are a band, or pixels, whose bands then have to give them back.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "wire/active_run.h"

namespace {

using namespace eyrie;

void readBands(std::string_view bytes, fabric::Image& image) {
    wire::BandDecoder decoder(image);
    while (!decoder.isDone())
        if (!decoder.take(bytes).ok())
            return;
}

void writeBands(std::string_view bytes, fabric::Image& image) {
    std::memcpy(image.colour.data(), bytes.data(), std::min(bytes.size(), image.colour.size() * 4));
    if (image.hasDepth())
        std::memcpy(image.depth.data(), bytes.data(),
                    std::min(bytes.size(), image.depth.size() * 4));
    fabric::Image copy = fabric::makeImage(image.area, {}, image.hasDepth());
    wire::BandEncoder encoder(image);
    wire::BandDecoder decoder(copy);
    for (std::string band; !encoder.isDone();) {
        encoder.next(band);
        if (!decoder.take(band).ok())
            std::abort();
    }
    if (std::memcmp(copy.colour.data(), image.colour.data(), image.colour.size() * 4) != 0 ||
        (image.hasDepth() &&
         std::memcmp(copy.depth.data(), image.depth.data(), image.depth.size() * 4) != 0))
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 5)
        return 0;
    const fabric::PixelViewport area{0, 0, 1 + data[0] + 256 * (data[1] % 8), 1 + data[2] % 64};
    fabric::Image image = fabric::makeImage(area, {}, data[3] % 2 != 0);
    const std::string_view rest(reinterpret_cast<const char*>(data) + 5, size - 5);
    if (data[4] % 2 == 0)
        readBands(rest, image);
    else
        writeBands(rest, image);
    return 0;
}
