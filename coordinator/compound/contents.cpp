// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/contents.h"

#include <algorithm>

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;
using fabric::Range;

Range around(const Range& a, const Range& b) {
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Whether two shares of one rectangle's columns and rows have none in common.
bool areApart(const Content& a, const Content& b) {
    return a.everyNth && b.everyNth && a.everyNth->of == b.everyNth->of &&
           a.everyNth->everyColumn == b.everyNth->everyColumn &&
           a.everyNth->everyRow == b.everyNth->everyRow &&
           (a.everyNth->firstColumn != b.everyNth->firstColumn ||
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

/// What of `block` is outside of `content`, in blocks: data before and after, then beside, below
/// and above it.
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
    const PixelViewport& whole = block.area;
    const PixelViewport inner = intersection(whole, content.area);
    const int right = inner.x + inner.width;
    const int top = inner.y + inner.height;
    add({whole.x, whole.y, inner.x - whole.x, whole.height}, both);
    add({right, whole.y, whole.x + whole.width - right, whole.height}, both);
    add({inner.x, whole.y, inner.width, inner.y - whole.y}, both);
    add({inner.x, top, inner.width, whole.y + whole.height - top}, both);
    return parts;
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
    constexpr std::size_t kLong = 1000;
    std::vector<Block> missing = {{area, range}};
    for (const Content& each : all_) {
        if (each.everyNth || !each.isFull)
            continue;
        std::vector<Block> next;
        for (const Block& block : missing) {
            if (!meet(block, each)) {
                next.push_back(block);
                continue;
            }
            for (const Block& part : outside(block, each)) next.push_back(part);
        }
        missing = std::move(next);
        if (missing.empty() || missing.size() > kLong)
            break;
    }
    return missing.empty();
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
    std::erase_if(all_, [&](const Content& each) { return area.contains(each.area); });
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
