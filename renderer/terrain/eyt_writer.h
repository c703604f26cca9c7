// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "renderer/terrain/codec/geometry_encoder.h"
#include "renderer/terrain/codec/normal_codec.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"
#include "renderer/terrain/tile_mesh.h"

namespace eyrie::terrain {

/// Puts the tiles of one page after the other together. Page::decode gives back what went in, in
/// the order of TileTriangulation. Keeps scratch memory: one object per thread.
class PageBuilder {
public:
    /// Give each tile its place once, in ascending order, all of one level. A mesh without indices
    /// is left out, as are normals where they are empty.
    /// Precondition: normals.size() is 0 or normalMapBytes(level).
    void add(int place, int level, const TileMesh& mesh, std::span<const std::int8_t> normals);

    /// The page's bytes; empty when no tile has triangles or normals. Starts the next page.
    std::vector<std::uint32_t> finish();

private:
    void addGeometry(int place, const TileMesh& mesh);

    PageHeader header_;
    bool hasTriangles_ = false;
    GeometryEncoder geometry_;
    NormalEncoder normals_;
};

/// Writes an .eyt file that appears under its name only when it is complete: bytes go to a file
/// beside it, which has no header before commit().
class EytWriter {
public:
    /// Into a file of its own, see fabric::createPartial, which goes with the writer unless that
    /// commits. Errors: InvalidArgument (a folder, a pipe or a device has this name), NotFound (no
    /// such folder), PermissionDenied, Unavailable.
    static absl::StatusOr<EytWriter> create(const std::string& path);

    /// Into `PATH.partial`, where an earlier writer may have left pages that takeWritten() takes.
    /// It goes with the writer, unless it was there before or keepUnfinished() says otherwise.
    /// Errors: those of create; FailedPrecondition (another writer is at work there).
    static absl::StatusOr<EytWriter> resume(const std::string& path);

    /// Removes what such a writer has left that was killed, unless another is at work there.
    static void removeUnfinished(const std::string& path);

    EytWriter(EytWriter&& other) noexcept;
    EytWriter& operator=(EytWriter&&) = delete;
    ~EytWriter();

    /// Appends a page; an empty one becomes a record of 0 bytes.
    /// Errors: ResourceExhausted (disk full), Unavailable.
    absl::StatusOr<PageRecord> addPage(std::span<const std::uint32_t> page);
    absl::StatusOr<PageRecord> addPage(std::span<const std::byte> page);

    /// Takes pages for written that addPage gave these records for in an earlier process: false,
    /// and nothing is taken, unless all their bytes are there and are the next ones.
    bool takeWritten(std::span<const PageRecord> pages);

    /// Whether what is written stays, for resume(), without commit().
    void keepUnfinished(bool keeps) { keepsUnfinished_ = keeps; }

    /// Writes index and header, flushes all to disk and renames. Returns the file's size.
    /// Precondition: index.pages holds what addPage returned.
    absl::StatusOr<std::uint64_t> commit(const EytIndex& index);

private:
    EytWriter(std::string path, std::string partialPath, int fd);

    bool readAt(std::span<char> out, std::uint64_t offset) const;
    absl::Status writeAt(const void* data, std::size_t bytes, std::uint64_t offset);
    void startDisk();

    std::string path_;
    std::string partialPath_;
    int fd_;
    std::uint64_t size_;
    std::uint64_t started_ = 0;  ///< of size_, what the disk was told to write
    bool keepsUnfinished_ = false;
};

}  // namespace eyrie::terrain
