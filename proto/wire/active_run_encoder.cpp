// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <optional>

#include "fabric/simd_clones.h"
#include "wire/active_run.h"
#include "wire/active_run_format.h"
#include "wire/bit_block.h"

namespace eyrie::wire {
namespace {

using namespace active_run;

/// Whether each pixel is to be in a run, 1 or 0. `depth` may be null.
EYRIE_SIMD_CLONES void findActive(const std::uint32_t* colour, const std::uint32_t* depth,
                                  std::uint32_t background, int count,
                                  std::uint8_t* __restrict active) {
    if (depth == nullptr)
        for (int i = 0; i < count; ++i) active[i] = colour[i] != background ? 1 : 0;
    else
        for (int i = 0; i < count; ++i)
            active[i] = ((colour[i] ^ background) | depth[i]) != 0 ? 1 : 0;
}

/// `slopes`: all ones where the row below predicts them, else 0.
EYRIE_SIMD_CLONES void differDepth(const std::uint32_t* depth, const std::uint32_t* below,
                                   std::uint32_t slopes, int count,
                                   std::uint32_t* __restrict residuals) {
    residuals[0] = fold(depth[0] - below[0]);
    for (int i = 1; i < count; ++i)
        residuals[i] = fold((depth[i] - depth[i - 1]) - ((below[i] - below[i - 1]) & slopes));
}

EYRIE_SIMD_CLONES void differColour(const std::uint32_t* colour, const std::uint32_t* below,
                                    std::uint32_t slopes, int count,
                                    std::uint32_t* __restrict residuals) {
    residuals[0] = subtractBytes(colour[0], below[0]);
    for (int i = 1; i < count; ++i)
        residuals[i] = subtractBytes(subtractBytes(colour[i], colour[i - 1]),
                                     subtractBytes(below[i], below[i - 1]) & slopes);
    for (int i = 0; i < count; ++i)
        residuals[i] = foldBytes(subtractBytes(residuals[i], greenTwice(residuals[i])));
}

/// Which bits any of a block's values has.
EYRIE_SIMD_CLONES std::uint32_t anyOf(const std::uint32_t* values) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < kBlockValues; ++i) any |= values[i];
    return any;
}

/// The lowest bits of four bytes, so many of each, without the others between.
EYRIE_SIMD_CLONES void joinBytes(const std::uint32_t* colours, const ByteBits& bits,
                                 std::uint32_t* __restrict joined) {
    const unsigned green = bits[0];
    const unsigned blue = green + bits[1];
    const unsigned alpha = blue + bits[2];
    for (std::size_t i = 0; i < kBlockValues; ++i)
        joined[i] = (colours[i] & 0xffU) | ((colours[i] >> 8) & 0xffU) << green |
                    ((colours[i] >> 16) & 0xffU) << blue | (colours[i] >> 24) << alpha;
}

unsigned bitsOf(std::uint32_t value) { return static_cast<unsigned>(std::bit_width(value)); }

char* put(char* to, const void* from, std::size_t bytes) {
    std::memcpy(to, from, bytes);
    return to + bytes;
}

/// Writes a block, and returns where it ends. `depths` may be null.
char* putBlock(const std::uint32_t* colours, const std::uint32_t* depths, char* to) {
    const std::uint32_t any = anyOf(colours);
    const ByteBits bits{bitsOf(any & 0xffU), bitsOf(any >> 8 & 0xffU), bitsOf(any >> 16 & 0xffU),
                        bitsOf(any >> 24)};
    *to++ = static_cast<char>(bits[0] | bits[1] << 4);
    *to++ = static_cast<char>(bits[2] | bits[3] << 4);
    const unsigned depthBits = depths == nullptr ? 0 : bitsOf(anyOf(depths));
    if (depths != nullptr)
        *to++ = static_cast<char>(depthBits);
    std::array<std::uint32_t, kBlockValues> joined;
    joinBytes(colours, bits, joined.data());
    const unsigned colourBits = bits[0] + bits[1] + bits[2] + bits[3];
    packBlock(joined.data(), colourBits, to);
    to += 2 * colourBits;
    if (depths != nullptr)
        packBlock(depths, depthBits, to);
    return to + 2 * depthBits;
}

/// Whether slopes below foretell those of this row, tried at every 16th pixel of its runs.
/// `cost` says how many bits a difference has.
template <auto subtract, auto cost>
bool slopesPay(const std::uint32_t* values, const std::uint32_t* below,
               const std::vector<Run>& runs) {
    int gain = 0;
    for (const Run& run : runs)
        for (int x = run.first + 1; x < run.first + run.pixels; x += 16) {
            const std::uint32_t slope = subtract(values[x], values[x - 1]);
            gain += static_cast<int>(cost(slope));
            gain -= static_cast<int>(cost(subtract(slope, subtract(below[x], below[x - 1]))));
        }
    return gain >= 0;
}

std::uint32_t subtractWords(std::uint32_t a, std::uint32_t b) { return a - b; }
unsigned depthCost(std::uint32_t difference) { return bitsOf(fold(difference)); }
unsigned colourCost(std::uint32_t difference) {
    const std::uint32_t folded = foldBytes(difference);
    return bitsOf((folded | folded >> 8 | folded >> 16) & 0xffU);
}

void findRuns(const std::vector<std::uint8_t>& active, std::vector<Run>& runs) {
    runs.clear();
    const auto next = [&](std::size_t from, int wanted) {
        const void* found = std::memchr(active.data() + from, wanted, active.size() - from);
        return found == nullptr ? active.size()
                                : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) -
                                                           active.data());
    };
    for (std::size_t first = next(0, 1); first < active.size();) {
        const std::size_t end = next(first, 0);
        runs.push_back(
            {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(end - first)});
        first = next(end, 1);
    }
}

/// Most that Form::Runs makes of a band: blocks of 3 + 2 * 64 bytes, rows of a run for every other
/// pixel.
std::size_t mostRunsBytes(std::size_t width, std::size_t rows) {
    const std::size_t blocks = (width * rows + kBlockValues - 1) / kBlockValues;
    return sizeof(BandHeader) + sizeof(RunsHeader) + blocks * (3 + 2 * 64) +
           rows * (2 + (width + 1) / 2 * sizeof(Run));
}

}  // namespace

class BandEncoder::Impl {
public:
    explicit Impl(const fabric::Image& image)
        : image_(image),
          width_(image.area.isEmpty() ? 0 : static_cast<std::size_t>(image.area.width)),
          height_(image.area.isEmpty() ? 0 : image.area.height),
          active_(width_),
          colours_(width_ + kBlockValues),
          depths_(image.hasDepth() ? width_ + kBlockValues : 0) {
        if (width_ == 0)
            return;
        rowsInBand_ = rowsInBand(image.area, image.hasDepth());
        scratch_ = std::make_unique_for_overwrite<char[]>(
            mostRunsBytes(width_, static_cast<std::size_t>(rowsInBand_)));
    }

    bool isDone() const { return row_ == height_; }

    void next(std::string& bytes) {
        assert(!isDone());
        const int rows = std::min(rowsInBand_, height_ - row_);
        const std::size_t pixels = width_ * static_cast<std::size_t>(rows);
        const std::size_t runsBytes = encodeRuns(rows);
        if (runsBytes <= pixels * (image_.hasDepth() ? 8 : 4))
            bytes.assign(scratch_.get(), runsBytes);
        else
            copyRaw(rows, pixels, bytes);
        row_ += rows;
    }

private:
    const std::uint32_t* colour(int row) const {
        return reinterpret_cast<const std::uint32_t*>(image_.colour.data()) + offset(row);
    }
    const std::uint32_t* depth(int row) const {
        return image_.hasDepth()
                   ? reinterpret_cast<const std::uint32_t*>(image_.depth.data()) + offset(row)
                   : nullptr;
    }
    std::size_t offset(int row) const { return width_ * static_cast<std::size_t>(row); }

    void copyRaw(int rows, std::size_t pixels, std::string& bytes) const {
        const BandHeader header{Form::Raw, 0, static_cast<std::uint16_t>(rows)};
        bytes.assign(reinterpret_cast<const char*>(&header), sizeof(header));
        bytes.append(reinterpret_cast<const char*>(colour(row_)), pixels * 4);
        if (image_.hasDepth())
            bytes.append(reinterpret_cast<const char*>(depth(row_)), pixels * 4);
    }

    /// The colour of the first pixel of nothing; without depth, the first pixel's.
    std::uint32_t findBackground(int rows) const {
        const std::uint32_t* depths = depth(row_);
        if (depths == nullptr)
            return *colour(row_);
        const std::uint32_t* end = depths + offset(rows);
        const std::uint32_t* nothing = std::find(depths, end, 0U);
        return nothing == end ? 0 : colour(row_)[nothing - depths];
    }

    std::size_t encodeRuns(int rows) {
        const BandHeader header{Form::Runs, 0, static_cast<std::uint16_t>(rows)};
        RunsHeader runsHeader{findBackground(rows), 0};
        char* const blocks = scratch_.get() + sizeof(header) + sizeof(runsHeader);
        end_ = blocks;
        rowTable_.clear();
        belowColour_.emplace(image_.area.width);
        belowDepth_.emplace(image_.hasDepth() ? image_.area.width : 0);
        for (int row = row_; row < row_ + rows; ++row) encodeRow(row, runsHeader.background);
        flush();
        runsHeader.blockBytes = static_cast<std::uint32_t>(end_ - blocks);
        put(put(scratch_.get(), &header, sizeof(header)), &runsHeader, sizeof(runsHeader));
        end_ = put(end_, rowTable_.data(), rowTable_.size() * sizeof(rowTable_[0]));
        return static_cast<std::size_t>(end_ - scratch_.get());
    }

    void encodeRow(int row, std::uint32_t background) {
        findActive(colour(row), depth(row), background, image_.area.width, active_.data());
        findRuns(active_, runs_);
        const bool depthSlopes = image_.hasDepth() && slopesPay<subtractWords, depthCost>(
                                                          depth(row), belowDepth_->at(0), runs_);
        const bool colourSlopes =
            slopesPay<subtractBytes, colourCost>(colour(row), belowColour_->at(0), runs_);
        rowTable_.push_back(static_cast<std::uint16_t>(runs_.size() << kRunCountShift |
                                                       (depthSlopes ? kDepthSlopes : 0) |
                                                       (colourSlopes ? kColourSlopes : 0)));
        for (const Run& run : runs_) {
            rowTable_.insert(rowTable_.end(), {run.first, run.pixels});
            differColour(colour(row) + run.first, belowColour_->at(run.first),
                         colourSlopes ? ~0U : 0, run.pixels, &colours_[pending_]);
            if (image_.hasDepth())
                differDepth(depth(row) + run.first, belowDepth_->at(run.first),
                            depthSlopes ? ~0U : 0, run.pixels, &depths_[pending_]);
            pending_ += run.pixels;
        }
        putFullBlocks();
        belowColour_->advance(colour(row), runs_);
        if (image_.hasDepth())
            belowDepth_->advance(depth(row), runs_);
    }

    void putFullBlocks() {
        std::size_t taken = 0;
        for (; taken + kBlockValues <= pending_; taken += kBlockValues)
            end_ = putBlock(&colours_[taken], image_.hasDepth() ? &depths_[taken] : nullptr, end_);
        std::copy(colours_.begin() + static_cast<std::ptrdiff_t>(taken),
                  colours_.begin() + static_cast<std::ptrdiff_t>(pending_), colours_.begin());
        if (image_.hasDepth())
            std::copy(depths_.begin() + static_cast<std::ptrdiff_t>(taken),
                      depths_.begin() + static_cast<std::ptrdiff_t>(pending_), depths_.begin());
        pending_ -= taken;
    }

    /// Writes what is left as a block that is filled up with 0.
    void flush() {
        if (pending_ == 0)
            return;
        std::fill_n(&colours_[pending_], kBlockValues - pending_, 0U);
        if (image_.hasDepth())
            std::fill_n(&depths_[pending_], kBlockValues - pending_, 0U);
        pending_ = kBlockValues;
        putFullBlocks();
    }

    const fabric::Image& image_;
    const std::size_t width_;
    const int height_;
    int rowsInBand_ = 0;
    int row_ = 0;  ///< the next band's first
    std::unique_ptr<char[]> scratch_;
    char* end_ = nullptr;  ///< of what is written into scratch_
    std::vector<std::uint8_t> active_;
    std::vector<Run> runs_;
    std::vector<std::uint16_t> rowTable_;
    std::vector<std::uint32_t> colours_;  ///< residuals, of which pending_ are not in a block yet
    std::vector<std::uint32_t> depths_;
    std::size_t pending_ = 0;
    std::optional<Neighbours> belowColour_;
    std::optional<Neighbours> belowDepth_;
};

BandEncoder::BandEncoder(const fabric::Image& image) : impl_(std::make_unique<Impl>(image)) {}
BandEncoder::~BandEncoder() = default;
bool BandEncoder::isDone() const { return impl_->isDone(); }
void BandEncoder::next(std::string& bytes) { impl_->next(bytes); }

}  // namespace eyrie::wire
