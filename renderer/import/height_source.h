// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::import {

/// Where the posts of an elevation model come from, a window at a time. One thread at a time.
class HeightSource {
public:
    virtual ~HeightSource() = default;

    virtual const terrain::GridFrame& frame() const = 0;
    /// Rows are stored from the last to the first: quicker read in that order.
    virtual bool isLastRowFirst() const = 0;
    /// So many columns are quicker read from the first to the last row before others are.
    virtual std::int32_t columnsAtOnce() const { return frame().columns; }
    /// The heights of a window of the frame, in metres, row by row; NaN is nodata, and there are no
    /// infinities. Errors: DataLoss.
    virtual absl::Status read(const terrain::PostRect& window, float* out) = 0;
    /// The stage of reading it all, for people: what takes long is said while it does.
    virtual std::string readingStage() const { return "reading"; }
    /// What was found in the posts read so far, for people.
    virtual std::vector<std::string> findings() const { return {}; }
    /// What an earlier job found in posts that need not be read again: among the findings from now
    /// on.
    virtual void foundBefore(std::vector<std::string> /*findings*/) {}
    /// Bytes of memory that reading takes beside what GDAL's cache has.
    virtual std::uint64_t readingBytes() const { return 0; }
    /// Gives back what reading holds in memory, for about as many bytes; nothing is read again.
    virtual std::uint64_t release() { return 0; }
};

/// A grid in memory, which is referred to.
class GridHeightSource : public HeightSource {
public:
    explicit GridHeightSource(const terrain::HeightGrid& grid)
        : grid_(grid), frame_(grid.frame()) {}

    const terrain::GridFrame& frame() const override { return frame_; }
    bool isLastRowFirst() const override { return false; }
    absl::Status read(const terrain::PostRect& window, float* out) override {
        for (std::int32_t j = 0; j < window.rows; ++j)
            out = std::copy_n(grid_.row(window.j + j) + window.i, window.columns, out);
        return absl::OkStatus();
    }

private:
    const terrain::HeightGrid& grid_;
    terrain::GridFrame frame_;
};

}  // namespace eyrie::import
