// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/status.h"
#include "renderer/mesh/output_file.h"

/// Numbered rows of one kind on disk, for what does not fit memory. The files have no names: they
/// are gone with the process, however that ends. Errors: those of mesh::OutputFile.
namespace eyrie::import {

/// Bytes that are read or written at once.
inline constexpr std::size_t kRowBufferBytes = std::size_t{1} << 20;

/// Rows that nobody wrote read as zeros.
template <typename Row>
class RowFile {
public:
    /// On the disk of `path`.
    static absl::StatusOr<RowFile> create(const std::string& path) {
        ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::createUnnamed(path));
        return RowFile(std::move(file));
    }

    absl::Status write(std::uint64_t first, std::span<const Row> rows) {
        return file_.writeAt(first * sizeof(Row), std::as_bytes(rows));
    }
    absl::Status read(std::uint64_t first, std::span<Row> rows) const {
        return file_.readAt(first * sizeof(Row), std::as_writable_bytes(rows));
    }
    absl::StatusOr<std::vector<Row>> readAll(std::uint64_t begin, std::uint64_t end) const {
        std::vector<Row> rows(end - begin);
        RETURN_IF_ERROR(read(begin, rows));
        return rows;
    }

    /// Calls `visit(std::span<const Row>)`, which returns an absl::Status, for the rows from
    /// `begin` to before `end`, in turn.
    template <typename Visit>
    absl::Status forBlocks(std::uint64_t begin, std::uint64_t end, const Visit& visit) const {
        std::vector<Row> rows(std::min<std::uint64_t>(end - begin, kRowBufferBytes / sizeof(Row)));
        for (std::uint64_t at = begin; at < end; at += rows.size()) {
            const std::span<Row> block = std::span(rows).first(
                static_cast<std::size_t>(std::min<std::uint64_t>(end - at, rows.size())));
            RETURN_IF_ERROR(read(at, block));
            RETURN_IF_ERROR(visit(std::span<const Row>(block)));
        }
        return absl::OkStatus();
    }

private:
    explicit RowFile(mesh::OutputFile file) : file_(std::move(file)) {}

    mesh::OutputFile file_;
};

/// Writes rows that belong to groups, those of each one after the other in the order they come.
template <typename Row>
class RowGroups {
public:
    /// Group i begins with row begins[i]. Takes about kRowBufferBytes a group, of many less.
    RowGroups(RowFile<Row>& file, std::span<const std::uint64_t> begins)
        : file_(file),
          next_(begins.begin(), begins.end()),
          pending_(begins.size()),
          most_(std::max<std::size_t>(
              64, kRowBufferBytes / sizeof(Row) / std::max<std::size_t>(1, begins.size() / 16))) {}

    absl::Status add(std::size_t group, const Row& row) {
        std::vector<Row>& rows = pending_[group];
        rows.push_back(row);
        return rows.size() < most_ ? absl::OkStatus() : flush(group);
    }
    /// To be called in the end.
    absl::Status finish() {
        for (std::size_t group = 0; group < pending_.size(); ++group) RETURN_IF_ERROR(flush(group));
        return absl::OkStatus();
    }

private:
    absl::Status flush(std::size_t group) {
        std::vector<Row>& rows = pending_[group];
        RETURN_IF_ERROR(file_.write(next_[group], rows));
        next_[group] += rows.size();
        rows.clear();
        return absl::OkStatus();
    }

    RowFile<Row>& file_;
    std::vector<std::uint64_t> next_;
    std::vector<std::vector<Row>> pending_;
    std::size_t most_;
};

/// Rows in groups, that of group i from begins[i] to before begins[i + 1].
template <typename Row>
struct GroupedRows {
    RowFile<Row> file;
    std::vector<std::uint64_t> begins;

    std::size_t groups() const { return begins.size() - 1; }
    absl::StatusOr<std::vector<Row>> read(std::size_t group) const {
        return file.readAll(begins[group], begins[group + 1]);
    }
};

/// Sorts rows into groups: they keep their order within one. `path`: as RowFile::create.
template <typename Row, typename GroupOf>
absl::StatusOr<GroupedRows<Row>> groupRows(const RowFile<Row>& rows, std::uint64_t count,
                                           std::size_t groups, const GroupOf& groupOf,
                                           const std::string& path) {
    ASSIGN_OR_RETURN(RowFile<Row> file, RowFile<Row>::create(path));
    GroupedRows<Row> grouped{std::move(file), std::vector<std::uint64_t>(groups + 1, 0)};
    RETURN_IF_ERROR(rows.forBlocks(0, count, [&](std::span<const Row> block) {
        for (const Row& row : block) ++grouped.begins[groupOf(row) + 1];
        return absl::OkStatus();
    }));
    for (std::size_t i = 1; i <= groups; ++i) grouped.begins[i] += grouped.begins[i - 1];
    RowGroups<Row> out(grouped.file, std::span(grouped.begins).first(groups));
    const auto addAll = [&](std::span<const Row> block) {
        for (const Row& row : block) RETURN_IF_ERROR(out.add(groupOf(row), row));
        return absl::OkStatus();
    };
    RETURN_IF_ERROR(rows.forBlocks(0, count, addAll));
    RETURN_IF_ERROR(out.finish());
    return grouped;
}

/// Rows in any order: keeps blocks of 64 KiB of those read last, so many at most. For one thread.
template <typename Row>
class RowCache {
public:
    explicit RowCache(const RowFile<Row>& file, std::size_t blocks = 1024)
        : file_(file), slots_(blocks) {}

    absl::StatusOr<const Row*> at(std::uint64_t row) {
        const std::uint64_t block = row / kRows;
        Slot& slot = slots_[block % slots_.size()];
        if (slot.block != block) {
            slot.rows.resize(kRows);
            slot.block = kNone;
            RETURN_IF_ERROR(file_.read(block * kRows, slot.rows));
            slot.block = block;
        }
        return &slot.rows[row % kRows];
    }

private:
    static constexpr std::size_t kRows = (std::size_t{64} << 10) / sizeof(Row);
    static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
    struct Slot {
        std::uint64_t block = kNone;
        std::vector<Row> rows;
    };

    const RowFile<Row>& file_;
    std::vector<Slot> slots_;
};

}  // namespace eyrie::import
