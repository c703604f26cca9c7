// SPDX-License-Identifier: Apache-2.0
#include "cli/image_files.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "cli/png_file.h"
#include "fabric/depth_metres.h"
#include "fabric/status.h"
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

class JpegFile final : public PictureFile {
public:
    JpegFile(mesh::OutputFile file, int width, int height)
        : file_(std::move(file)), picture_(fabric::makeImage({0, 0, width, height}, {}, false)) {}

    absl::Status append(const fabric::Image& rows) override {
        fabric::paste(rows, picture_);
        return absl::OkStatus();
    }

    absl::Status commit() override {
        ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                         wire::encodeJpeg(picture_, kJpegQuality, wire::ChromaSubsampling::None));
        RETURN_IF_ERROR(file_.write(bytes));
        return file_.commit();
    }

private:
    mesh::OutputFile file_;
    fabric::Image picture_;
};

}  // namespace

absl::Status writeText(std::string_view text, const std::string& path,
                       const std::stop_token& stop) {
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path, stop));
    RETURN_IF_ERROR(file.write(std::as_bytes(std::span(text))));
    return file.commit();
}

absl::Status checkPictureName(const std::string& path, std::string_view option) {
    if (isJpeg(path) || ending(path) == ".png")
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("{} is '{}'; its name must end in .png, .jpg or .jpeg", option, path));
}

absl::StatusOr<std::unique_ptr<PictureFile>> PictureFile::create(const std::string& path, int width,
                                                                 int height,
                                                                 const std::stop_token& stop) {
    RETURN_IF_ERROR(checkPictureName(path, "picture"));
    if (!isJpeg(path))
        return createPng(path, width, height, stop);
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path, stop));
    return std::make_unique<JpegFile>(std::move(file), width, height);
}

absl::StatusOr<DepthFile> DepthFile::create(const std::string& path, int width, int height) {
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path));
    const std::string header = fabric::floatMapHead(width, height);
    RETURN_IF_ERROR(file.write(std::as_bytes(std::span(header))));
    return DepthFile(std::move(file));
}

absl::Status DepthFile::put(const fabric::Image& rows) {
    const std::vector<float> metres = fabric::depthMetres(rows);
    const auto before =
        static_cast<std::uint64_t>(rows.area.y) * static_cast<std::uint64_t>(rows.area.width);
    return file_.writeAt(file_.size() + before * sizeof(float), std::as_bytes(std::span(metres)));
}

}  // namespace eyrie::cli
