// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "renderer/mesh/output_file.h"

/// Pictures on disk, written from the top down, so that a large one is never in memory whole. Every
/// file appears under its name only when it is complete. `stop` is as of mesh::OutputFile.
/// Errors: those of mesh::OutputFile; InvalidArgument where said.
namespace eyrie::cli {

/// Whether PictureFile knows the ending of `path`; the message names `option`.
absl::Status checkPictureName(const std::string& path, std::string_view option);

/// The colour of a picture.
class PictureFile {
public:
    /// 8-bit RGB PNG or, for .jpg and .jpeg, JPEG of quality 95 without subsampling, whose pixels
    /// are kept until commit(). InvalidArgument for another ending.
    static absl::StatusOr<std::unique_ptr<PictureFile>> create(const std::string& path, int width,
                                                               int height,
                                                               const std::stop_token& stop = {});

    virtual ~PictureFile() = default;

    /// The next rows down. Precondition: as wide as the picture, `rows.area` in it and right below
    /// what was appended before.
    virtual absl::Status append(const fabric::Image& rows) = 0;

    /// Precondition: all rows were appended.
    virtual absl::Status commit() = 0;
};

/// View-space depth in metres as PFM: 32-bit little-endian floats, bottom row first, infinity where
/// nothing was hit that is opaque.
class DepthFile {
public:
    static absl::StatusOr<DepthFile> create(const std::string& path, int width, int height);

    /// Rows anywhere in the picture. Precondition: rows.hasDepth(), and they are as wide as it.
    absl::Status put(const fabric::Image& rows);

    /// Precondition: all rows were put.
    absl::Status commit() { return file_.commit(); }

private:
    explicit DepthFile(mesh::OutputFile file) : file_(std::move(file)) {}

    mesh::OutputFile file_;
};

absl::Status writeText(std::string_view text, const std::string& path,
                       const std::stop_token& stop = {});

}  // namespace eyrie::cli
