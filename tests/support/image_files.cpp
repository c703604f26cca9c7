// SPDX-License-Identifier: Apache-2.0
#include "tests/support/image_files.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <png.h>

namespace eyrie::test {

absl::StatusOr<fabric::Image> readPng(const std::string& path) {
    png_image file{};
    file.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&file, path.c_str()) == 0)
        return absl::InvalidArgumentError(fmt::format("{}: {}", path, file.message));
    file.format = PNG_FORMAT_RGBA;
    fabric::Image image = fabric::makeImage(
        {0, 0, static_cast<int>(file.width), static_cast<int>(file.height)}, {}, false);
    // A negative stride has libpng put the file's first row, the top one, last.
    const auto stride = static_cast<png_int_32>(file.width * sizeof(fabric::Rgba));
    if (png_image_finish_read(&file, nullptr, image.colour.data(), -stride, nullptr) == 0)
        return absl::InvalidArgumentError(fmt::format("{}: {}", path, file.message));
    return image;
}

absl::StatusOr<DepthPicture> readPfm(const std::string& path) {
    const absl::StatusOr<std::string> text = readFile(path);
    if (!text.ok())
        return text.status();
    std::istringstream file(*text);
    std::string magic;
    DepthPicture picture;
    file >> magic >> picture.width >> picture.height >> picture.scale;
    if (!file || magic != "Pf" || picture.width <= 0 || picture.height <= 0 || picture.scale >= 0 ||
        file.get() != '\n')
        return absl::InvalidArgumentError(
            fmt::format("{}: no header of a little-endian one-channel PFM", path));
    const auto pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    const auto header = static_cast<std::size_t>(file.tellg());
    if (text->size() - header != pixels * sizeof(float))
        return absl::InvalidArgumentError(fmt::format("{}: {} bytes of pixels, expected {}", path,
                                                      text->size() - header,
                                                      pixels * sizeof(float)));
    picture.metres.resize(pixels);
    std::memcpy(picture.metres.data(), text->data() + header, pixels * sizeof(float));
    return picture;
}

absl::StatusOr<std::string> readFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return absl::NotFoundError(fmt::format("{}: cannot be opened", path));
    return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace eyrie::test
