// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/contents.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;
using fabric::Range;

Range around(const Range& a, const Range& b) {
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Whether two are shares of one rectangle's columns and rows, counted alike.
bool areSharesOf(const Content& a, const Content& b) {
    return a.everyNth && b.everyNth && a.everyNth->of == b.everyNth->of &&
           a.everyNth->everyColumn == b.everyNth->everyColumn &&
           a.everyNth->everyRow == b.everyNth->everyRow;
}

/// Whether two shares of one rectangle's columns and rows have none in common.
bool areApart(const Content& a, const Content& b) {
    return areSharesOf(a, b) && (a.everyNth->firstColumn != b.everyNth->firstColumn ||
                                 a.everyNth->firstRow != b.everyNth->firstRow);
}

/// Whether two are shares of the same.
bool belongTogether(const Content& a, const Content& b) {
    return areApart(a, b) && a.area == b.area && a.range == b.range && a.isFull && b.isFull;
}

/// A part of the picture and of the data.
struct Block {
    PixelViewport area;
    Range range;
};

bool meet(const Block& block, const Content& content) {
    return !intersection(block.area, content.area).isEmpty() &&
           block.range.begin < content.range.end && content.range.begin < block.range.end;
}

/// What of `whole` is outside of `inner`, which lies in it: beside, below and above it.
std::vector<PixelViewport> outside(const PixelViewport& whole, const PixelViewport& inner) {
    const int right = inner.x + inner.width;
    const int top = inner.y + inner.height;
    std::vector<PixelViewport> parts = {
        {whole.x, whole.y, inner.x - whole.x, whole.height},
        {right, whole.y, whole.x + whole.width - right, whole.height},
        {inner.x, whole.y, inner.width, inner.y - whole.y},
        {inner.x, top, inner.width, whole.y + whole.height - top}};
    std::erase_if(parts, [](const PixelViewport& part) { return part.isEmpty(); });
    return parts;
}

/// What of `block` is outside of `content`, in blocks: data before and after, then around it.
std::vector<Block> outside(const Block& block, const Content& content) {
    std::vector<Block> parts;
    const auto add = [&](const PixelViewport& area, const Range& range) {
        if (!area.isEmpty() && range.begin < range.end)
            parts.push_back({area, range});
    };
    add(block.area, {block.range.begin, content.range.begin});
    add(block.area, {content.range.end, block.range.end});
    const Range both{std::max(block.range.begin, content.range.begin),
                     std::min(block.range.end, content.range.end)};
    for (const PixelViewport& part : outside(block.area, intersection(block.area, content.area)))
        add(part, both);
    return parts;
}

constexpr std::size_t kLong = 1000;

/// What of `blocks` is outside of `content`.
std::vector<Block> outside(const std::vector<Block>& blocks, const Content& content) {
    std::vector<Block> left;
    for (const Block& block : blocks) {
        if (!meet(block, content)) {
            left.push_back(block);
            continue;
        }
        for (const Block& part : outside(block, content)) left.push_back(part);
    }
    return left;
}

Block common(const Block& block, const Content& content) {
    return {intersection(block.area, content.area),
            {std::max(block.range.begin, content.range.begin),
             std::min(block.range.end, content.range.end)}};
}

/// After how many of `count` columns or rows the same of `shares` come again; `count` where they
/// do not.
std::int64_t periodOf(std::span<const Content* const> shares, std::int32_t count,
                      std::int32_t fabric::Regridding::*every) {
    std::int64_t period = 1;
    for (const Content* const each : shares)
        period = std::min<std::int64_t>(count, std::lcm(period, (*each->everyNth).*every));
    return period;
}

/// The first of the columns or rows from `begin` on that is `first` more than a multiple of
/// `every`.
std::int64_t firstFrom(std::int64_t begin, std::int64_t first, std::int64_t every) {
    const std::int64_t before = (begin - first) % every;
    return before <= 0 ? -before : every - before;
}

/// How much is missing of the pixels of `area`, where each of `shares` is all over it. Nothing
/// where that takes more looks than are left.
std::optional<double> missingOf(const PixelViewport& area, std::span<const Content* const> shares,
                                std::int64_t& looksLeft) {
    const std::int64_t columns = periodOf(shares, area.width, &fabric::Regridding::everyColumn);
    const std::int64_t rows = periodOf(shares, area.height, &fabric::Regridding::everyRow);
    const auto looksEach = static_cast<std::int64_t>(shares.size()) + 1;
    if (columns * rows > looksLeft / looksEach)
        return std::nullopt;
    looksLeft -= columns * rows * looksEach;
    std::vector<bool> isThere(static_cast<std::size_t>(columns * rows), false);
    for (const Content* const each : shares) {
        const fabric::Regridding& share = *each->everyNth;
        const std::int64_t column =
            firstFrom(area.x, share.of.x + share.firstColumn, share.everyColumn);
        for (std::int64_t row = firstFrom(area.y, share.of.y + share.firstRow, share.everyRow);
             row < rows; row += share.everyRow)
            for (std::int64_t x = column; x < columns; x += share.everyColumn)
                isThere[static_cast<std::size_t>(row * columns + x)] = true;
    }
    std::int64_t missing = 0;
    for (std::int64_t row = 0; row < rows; ++row)
        for (std::int64_t column = 0; column < columns; ++column)
            if (!isThere[static_cast<std::size_t>(row * columns + column)])
                missing += ((area.width - column + columns - 1) / columns) *
                           ((area.height - row + rows - 1) / rows);
    return static_cast<double>(missing) / static_cast<double>(area.area());
}

}  // namespace

std::optional<Range> Contents::met(const Content& content) const {
    std::optional<Range> range;
    for (const Content& each : all_)
        if (!intersection(each.area, content.area).isEmpty() && !areApart(each, content))
            range = range ? around(*range, each.range) : each.range;
    return range;
}

std::optional<Range> Contents::range() const {
    std::optional<Range> range;
    for (const Content& each : all_) range = range ? around(*range, each.range) : each.range;
    return range;
}

bool Contents::cover(const PixelViewport& area, const Range& range) const {
    std::vector<Block> missing = {{area, range}};
    for (const Content& each : all_) {
        if (each.everyNth || !each.isFull)
            continue;
        missing = outside(missing, each);
        if (missing.empty() || missing.size() > kLong)
            break;
    }
    return missing.empty();
}

std::vector<Gap> Contents::gaps(const PixelViewport& area) const {
    std::vector<Block> open = {{area, {}}};
    std::vector<const Content*> shares;
    for (const Content& each : all_) {
        if (each.everyNth && each.isFull)
            shares.push_back(&each);
        else
            open = outside(open, each);
        if (open.size() > kLong)
            return {};
    }
    std::vector<Gap> missing;
    std::int64_t looksLeft = 1'000'000;
    for (std::size_t tried = 0; !open.empty(); ++tried) {
        if (tried > kLong)
            return {};
        const Block block = open.back();
        open.pop_back();
        std::vector<const Content*> there;
        const Content* part = nullptr;  // that has some of the block only
        for (const Content* const each : shares) {
            if (!meet(block, *each))
                continue;
            there.push_back(each);
            if (!outside(block, *each).empty())
                part = each;
        }
        if (part != nullptr) {
            for (const Block& beside : outside(block, *part)) open.push_back(beside);
            open.push_back(common(block, *part));
        } else if (const auto share = missingOf(block.area, there, looksLeft).value_or(0);
                   share > 0) {
            missing.push_back({block.area, block.range, share});
        }
    }
    return missing;
}

bool Contents::hasOnlyPartOfTheData() const {
    return std::ranges::any_of(all_, [this](const Content& each) {
        return each.everyNth ? range() != Range{} : !gaps(each.area).empty();
    });
}

void Contents::add(const Content& content) {
    if (content.everyNth) {
        const auto isSame = [&](const Content& each) {
            return each.everyNth == content.everyNth && each.area == content.area &&
                   each.range == content.range && each.isFull == content.isFull;
        };
        if (std::ranges::any_of(all_, isSame))
            return;
        const auto isOther = [&](const Content& each) { return belongTogether(each, content); };
        const auto others = std::ranges::count_if(all_, isOther);
        const std::int64_t shares =
            std::int64_t{content.everyNth->everyColumn} * content.everyNth->everyRow;
        if (others + 1 == shares) {
            std::erase_if(all_, isOther);
            all_.push_back({content.area, content.range, {}, true});
            return;
        }
    }
    all_.push_back(content);
}

void Contents::clear(const PixelViewport& area) {
    std::vector<Content> left;
    for (const Content& each : all_) {
        const PixelViewport cleared = intersection(each.area, area);
        if (cleared.isEmpty() || (cleared != each.area && left.size() > kLong)) {
            left.push_back(each);
            continue;
        }
        for (const PixelViewport& part : outside(each.area, cleared))
            left.emplace_back(each).area = part;
    }
    all_ = std::move(left);
}

Contents Contents::within(const PixelViewport& area) const {
    Contents part;
    for (Content each : all_) {
        each.area = intersection(each.area, area);
        if (!each.area.isEmpty())
            part.add(each);
    }
    return part;
}

}  // namespace eyrie::compound
