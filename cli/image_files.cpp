// SPDX-License-Identifier: Apache-2.0
// PFM: P. Debevec's portable float map; a negative scale says that the bytes are little-endian.
#include "cli/image_files.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "fabric/frustum.h"
#include "fabric/status.h"
#include "renderer/mesh/output_file.h"
#include "wire/jpeg.h"

namespace eyrie::cli {
namespace {

constexpr int kJpegQuality = 95;

std::string ending(const std::string& path) {
    std::string text = std::filesystem::path(path).extension().string();
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool isJpeg(const std::string& path) { return ending(path) == ".jpg" || ending(path) == ".jpeg"; }

}  // namespace

absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.colour.size() * 3);
    for (const fabric::Rgba& pixel : image.colour)
        rgb.insert(rgb.end(), {pixel.r, pixel.g, pixel.b});
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.area.width);
    png.height = static_cast<png_uint_32>(image.area.height);
    png.format = PNG_FORMAT_RGB;
    const auto bottomUp = -image.area.width * 3;  // a negative stride starts at the last row
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), bottomUp, nullptr) == 0)
        return absl::InternalError(fmt::format("PNG encoder: {}", png.message));
    bytes.resize(size);
    return bytes;
}

absl::Status writeFile(std::span<const std::byte> bytes, const std::string& path) {
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path));
    RETURN_IF_ERROR(file.write(bytes));
    return file.commit();
}

absl::Status writeText(std::string_view text, const std::string& path) {
    return writeFile(std::as_bytes(std::span(text)), path);
}

absl::Status checkPictureName(const std::string& path, std::string_view option) {
    if (isJpeg(path) || ending(path) == ".png")
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("{} is '{}'; its name must end in .png, .jpg or .jpeg", option, path));
}

absl::Status writePicture(const fabric::Image& image, const std::string& path) {
    RETURN_IF_ERROR(checkPictureName(path, "picture"));
    ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                     isJpeg(path)
                         ? wire::encodeJpeg(image, kJpegQuality, wire::ChromaSubsampling::None)
                         : encodePng(image));
    return writeFile(bytes, path);
}

absl::Status writeDepth(const fabric::Image& image, const std::string& path) {
    static_assert(std::endian::native == std::endian::little);
    std::vector<float> metres;
    metres.reserve(image.depth.size());
    for (const float reversed : image.depth)
        metres.push_back(
            static_cast<float>(fabric::viewDepthMetres(reversed, fabric::kNearMetres)));
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path));
    const std::string header =
        fmt::format("Pf\n{} {}\n-1.0\n", image.area.width, image.area.height);
    RETURN_IF_ERROR(file.write(std::as_bytes(std::span(header))));
    RETURN_IF_ERROR(file.write(std::as_bytes(std::span(metres))));
    return file.commit();
}

}  // namespace eyrie::cli
