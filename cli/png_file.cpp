// SPDX-License-Identifier: Apache-2.0
#include "cli/png_file.h"

#include <cstddef>
#include <vector>

#include "fabric/status.h"
#include "renderer/mesh/output_file.h"
#include "wire/png.h"

namespace eyrie::cli {
namespace {

class PngFile final : public PictureFile {
public:
    PngFile(mesh::OutputFile file, int width, int height)
        : file_(std::move(file)), writer_(width, height, wire::PngColours::Srgb) {}

    absl::Status append(const fabric::Image& rows) override {
        written_.clear();
        writer_.append(rows, written_);
        return file_.write(written_);
    }

    absl::Status commit() override { return file_.commit(); }

private:
    mesh::OutputFile file_;
    wire::PngWriter writer_;
    std::vector<std::byte> written_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<PictureFile>> createPng(const std::string& path, int width,
                                                       int height, const std::stop_token& stop) {
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path, stop));
    return std::make_unique<PngFile>(std::move(file), width, height);
}

}  // namespace eyrie::cli
