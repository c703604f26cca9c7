// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include <fmt/format.h>

#include "fabric/simd_clones.h"
#include "fabric/status.h"
#include "wire/active_run.h"
#include "wire/active_run_format.h"
#include "wire/bit_block.h"

namespace eyrie::wire {
namespace {

using namespace active_run;

template <typename... Values>
absl::Status broken(fmt::format_string<Values...> format, Values&&... values) {
    return absl::DataLossError("band of pixels: " +
                               fmt::format(format, std::forward<Values>(values)...));
}

/// What is left to read of a band.
class Bytes {
public:
    explicit Bytes(std::string_view bytes) : left_(bytes) {}

    std::size_t size() const { return left_.size(); }
    std::string_view rest() const { return left_; }

    std::optional<std::string_view> take(std::size_t count) {
        if (count > left_.size())
            return std::nullopt;
        const std::string_view taken = left_.substr(0, count);
        left_.remove_prefix(count);
        return taken;
    }

    template <typename T>
    bool read(T& value) {
        const std::optional<std::string_view> taken = take(sizeof(T));
        if (taken)
            std::memcpy(&value, taken->data(), sizeof(T));
        return taken.has_value();
    }

private:
    std::string_view left_;
};

/// From joined bytes back to the differences of colours.
EYRIE_SIMD_CLONES void splitBytes(const std::uint32_t* joined, const ByteBits& bits,
                                  std::uint32_t* __restrict colours) {
    const unsigned green = bits[0];
    const unsigned blue = green + bits[1];
    const unsigned alpha = blue + bits[2];
    const std::uint32_t redMask = (1U << bits[0]) - 1;
    const std::uint32_t greenMask = (1U << bits[1]) - 1;
    const std::uint32_t blueMask = (1U << bits[2]) - 1;
    const std::uint32_t alphaMask = (1U << bits[3]) - 1;
    for (std::size_t i = 0; i < kBlockValues; ++i) {
        const std::uint32_t differences = unfoldBytes(
            (joined[i] & redMask) | (joined[i] >> green & greenMask) << 8 |
            (joined[i] >> blue & blueMask) << 16 | (joined[i] >> alpha & alphaMask) << 24);
        colours[i] = addBytes(differences, greenTwice(differences));
    }
}

EYRIE_SIMD_CLONES void unfoldAll(std::uint32_t* values) {
    for (std::size_t i = 0; i < kBlockValues; ++i) values[i] = unfold(values[i]);
}

/// `residuals` are differences from what is predicted; `add` is addition of words or of bytes.
template <auto add>
void undoDifferences(const std::uint32_t* residuals, const std::uint32_t* below, bool slopes,
                     int count, std::uint32_t* values) {
    std::uint32_t sum = slopes ? 0 : below[0];
    if (!slopes)
        for (int i = 0; i < count; ++i) values[i] = sum = add(sum, residuals[i]);
    else  // the sum is by how much a pixel is above the one below it
        for (int i = 0; i < count; ++i) values[i] = add(below[i], sum = add(sum, residuals[i]));
}

std::uint32_t addWords(std::uint32_t a, std::uint32_t b) { return a + b; }

/// The residuals of a band, read block by block.
class Residuals {
public:
    Residuals(int width, bool hasDepth)
        : hasDepth_(hasDepth),
          colours_(static_cast<std::size_t>(width) + kBlockValues),
          depths_(hasDepth ? colours_.size() : 0) {}

    void start(std::string_view blocks) {
        blocks_ = Bytes(blocks);
        begin_ = end_ = 0;
    }

    /// Has `count` more, a row's at most, of what colours() and depths() point at.
    absl::Status need(std::size_t count) {
        moveToFront();
        while (end_ < count) RETURN_IF_ERROR(readBlock());
        return absl::OkStatus();
    }

    const std::uint32_t* colours() const { return &colours_[begin_]; }
    const std::uint32_t* depths() const { return &depths_[begin_]; }
    void skip(std::size_t count) { begin_ += count; }
    std::size_t bytesLeft() const { return blocks_.size(); }

private:
    void moveToFront() {
        const std::size_t count = end_ - begin_;
        std::copy_n(colours_.begin() + static_cast<std::ptrdiff_t>(begin_), count,
                    colours_.begin());
        if (hasDepth_)
            std::copy_n(depths_.begin() + static_cast<std::ptrdiff_t>(begin_), count,
                        depths_.begin());
        begin_ = 0;
        end_ = count;
    }

    absl::Status readBlock() {
        std::array<std::uint8_t, 3> header{};
        const std::optional<std::string_view> read = blocks_.take(hasDepth_ ? 3 : 2);
        if (!read)
            return broken("the blocks end before the runs do");
        std::memcpy(header.data(), read->data(), read->size());
        const ByteBits bits{header[0] & 15U, unsigned{header[0]} >> 4, header[1] & 15U,
                            unsigned{header[1]} >> 4};
        if (*std::max_element(bits.begin(), bits.end()) > 8 || header[2] > 32)
            return broken(
                "a block has bytes of {}, {}, {} and {} bits, depths of {}; 8 and 32 are "
                "the most",
                bits[0], bits[1], bits[2], bits[3], header[2]);
        const unsigned colourBits = bits[0] + bits[1] + bits[2] + bits[3];
        const std::optional<std::string_view> values = blocks_.take(2 * (colourBits + header[2]));
        if (!values)
            return broken("the last block is cut off");
        std::array<std::uint32_t, kBlockValues> joined;
        unpackBlock(values->data(), colourBits, joined.data());
        splitBytes(joined.data(), bits, &colours_[end_]);
        if (hasDepth_) {
            unpackBlock(values->data() + 2 * colourBits, header[2], &depths_[end_]);
            unfoldAll(&depths_[end_]);
        }
        end_ += kBlockValues;
        return absl::OkStatus();
    }

    const bool hasDepth_;
    Bytes blocks_{{}};
    std::vector<std::uint32_t> colours_;  ///< those from begin_ to end_ are not used yet
    std::vector<std::uint32_t> depths_;
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
};

}  // namespace

class BandDecoder::Impl {
public:
    explicit Impl(fabric::Image& image)
        : image_(image),
          width_(image.area.isEmpty() ? 0 : image.area.width),
          height_(image.area.isEmpty() ? 0 : image.area.height),
          residuals_(width_, image.hasDepth()) {}

    bool isDone() const { return row_ == height_; }

    absl::Status take(std::string_view band) {
        Bytes bytes(band);
        BandHeader header;
        if (!bytes.read(header))
            return broken("it has {} bytes, too few for a header", band.size());
        if (header.rows == 0 || header.rows > height_ - row_)
            return broken("it has {} rows, where {} are left", header.rows, height_ - row_);
        if (header.form == Form::Raw)
            RETURN_IF_ERROR(copyRaw(header.rows, bytes));
        else if (header.form == Form::Runs)
            RETURN_IF_ERROR(decodeRuns(header.rows, bytes));
        else
            return broken("its form is {}, which this version does not know",
                          static_cast<int>(header.form));
        row_ += header.rows;
        return absl::OkStatus();
    }

private:
    std::size_t offset(int row) const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(row);
    }
    std::uint32_t* colour(int row) {
        return reinterpret_cast<std::uint32_t*>(image_.colour.data()) + offset(row);
    }
    std::uint32_t* depth(int row) {
        return reinterpret_cast<std::uint32_t*>(image_.depth.data()) + offset(row);
    }

    absl::Status copyRaw(int rows, Bytes bytes) {
        const std::size_t size = offset(rows) * 4;
        const std::size_t expected = image_.hasDepth() ? 2 * size : size;
        if (bytes.size() != expected)
            return broken("{} rows of {} pixels have {} bytes, not {}", rows, width_, expected,
                          bytes.size());
        std::memcpy(colour(row_), bytes.rest().data(), size);
        if (image_.hasDepth())
            std::memcpy(depth(row_), bytes.rest().data() + size, size);
        return absl::OkStatus();
    }

    absl::Status decodeRuns(int rows, Bytes bytes) {
        RunsHeader header;
        if (!bytes.read(header))
            return broken("its header is cut off");
        const std::optional<std::string_view> blocks = bytes.take(header.blockBytes);
        if (!blocks)
            return broken("its blocks have {} bytes, but {} are left", header.blockBytes,
                          bytes.size());
        residuals_.start(*blocks);
        Neighbours belowColour(width_);
        Neighbours belowDepth(image_.hasDepth() ? width_ : 0);
        for (int row = row_; row < row_ + rows; ++row)
            RETURN_IF_ERROR(decodeRow(row, header.background, bytes, belowColour, belowDepth));
        if (bytes.size() != 0 || residuals_.bytesLeft() != 0)
            return broken("{} bytes follow its last row, and {} its last block", bytes.size(),
                          residuals_.bytesLeft());
        return absl::OkStatus();
    }

    absl::Status decodeRow(int row, std::uint32_t background, Bytes& table, Neighbours& belowColour,
                           Neighbours& belowDepth) {
        std::uint16_t head = 0;
        if (!table.read(head))
            return broken("its table of rows ends at row {}", row - row_);
        RETURN_IF_ERROR(readRuns(head >> kRunCountShift, table));
        int at = 0;
        for (const Run& run : runs_) {
            fillGap(row, at, run.first, background);
            at = run.first + run.pixels;
            undoDifferences<addBytes>(residuals_.colours(), belowColour.at(run.first),
                                      (head & kColourSlopes) != 0, run.pixels,
                                      colour(row) + run.first);
            if (image_.hasDepth())
                undoDifferences<addWords>(residuals_.depths(), belowDepth.at(run.first),
                                          (head & kDepthSlopes) != 0, run.pixels,
                                          depth(row) + run.first);
            residuals_.skip(run.pixels);
        }
        fillGap(row, at, width_, background);
        belowColour.advance(colour(row), runs_);
        if (image_.hasDepth())
            belowDepth.advance(depth(row), runs_);
        return absl::OkStatus();
    }

    /// Runs that ascend and lie in the row, and their residuals.
    absl::Status readRuns(int count, Bytes& table) {
        runs_.clear();
        int end = 0;
        std::size_t pixels = 0;
        for (int i = 0; i < count; ++i) {
            Run run;
            if (!table.read(run))
                return broken("its table of rows ends amid runs");
            if (run.pixels == 0 || run.first < end || run.first + run.pixels > width_)
                return broken("a run of {} pixels from {}, where a row has {} to {} left",
                              run.pixels, run.first, end, width_);
            end = run.first + run.pixels;
            pixels += run.pixels;
            runs_.push_back(run);
        }
        return residuals_.need(pixels);
    }

    void fillGap(int row, int begin, int end, std::uint32_t background) {
        std::fill(colour(row) + begin, colour(row) + end, background);
        if (image_.hasDepth())
            std::fill(depth(row) + begin, depth(row) + end, 0U);
    }

    fabric::Image& image_;
    const int width_;
    const int height_;
    int row_ = 0;  ///< the next band's first
    std::vector<Run> runs_;
    Residuals residuals_;
};

BandDecoder::BandDecoder(fabric::Image& image) : impl_(std::make_unique<Impl>(image)) {}
BandDecoder::~BandDecoder() = default;
bool BandDecoder::isDone() const { return impl_->isDone(); }
absl::Status BandDecoder::take(std::string_view bytes) { return impl_->take(bytes); }

}  // namespace eyrie::wire
