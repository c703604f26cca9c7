// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/lone_posts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

using terrain::PostRect;

/// Whether a post with data is a corner of half a cell of ground; hasData(di, dj) tells of those
/// around it.
template <typename HasData>
bool hasGround(HasData hasData) {
    for (const int dj : {-1, 1})
        for (const int di : {-1, 1})
            if (int{hasData(di, 0)} + int{hasData(0, dj)} + int{hasData(di, dj)} >= 2)
                return true;
    return false;
}

/// Heights of a window, which are referred to.
struct Heights {
    PostRect rect;
    const std::vector<float>& posts;

    bool hasData(std::int32_t i, std::int32_t j) const {
        const std::int32_t u = i - rect.i;
        const std::int32_t v = j - rect.j;
        if (u < 0 || v < 0 || u >= rect.columns || v >= rect.rows)
            return false;
        const float height = posts[placeOf(u, v)];
        return height == height;
    }
    std::size_t placeOf(std::int32_t u, std::int32_t v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(rect.columns) +
               static_cast<std::size_t>(u);
    }
};

/// Calls visit(i, j) once for each post on a window's border.
template <typename Visit>
void forEachOnBorder(const PostRect& rect, Visit visit) {
    for (std::int32_t v = 0; v < rect.rows; ++v) {
        const bool isWhole = v == 0 || v == rect.rows - 1;
        const std::int32_t step = isWhole ? 1 : std::max(1, rect.columns - 1);
        for (std::int32_t u = 0; u < rect.columns; u += step) visit(rect.i + u, rect.j + v);
    }
}

/// The rows beyond a window, corners included, and the columns beside it; empty past the frame.
std::array<PostRect, 4> sidesOf(const PostRect& rect, const terrain::GridFrame& frame) {
    const std::int32_t endI = rect.i + rect.columns;
    const std::int32_t endJ = rect.j + rect.rows;
    const std::int32_t i0 = std::max(0, rect.i - 1);
    const std::int32_t columns = std::min(frame.columns, endI + 1) - i0;
    return {PostRect{i0, rect.j - 1, columns, rect.j > 0 ? 1 : 0},
            PostRect{i0, endJ, columns, endJ < frame.rows ? 1 : 0},
            PostRect{rect.i - 1, rect.j, rect.i > 0 ? 1 : 0, rect.rows},
            PostRect{endI, rect.j, endI < frame.columns ? 1 : 0, rect.rows}};
}

using Post = std::pair<std::int32_t, std::int32_t>;

/// Of a window's border, those of which the window does not tell that they have ground.
std::vector<Post> doubtful(const Heights& window) {
    std::vector<Post> found;
    forEachOnBorder(window.rect, [&](std::int32_t i, std::int32_t j) {
        if (window.hasData(i, j) &&
            !hasGround([&](int di, int dj) { return window.hasData(i + di, j + dj); }))
            found.emplace_back(i, j);
    });
    return found;
}

/// Of the posts around a window, those that are around some of its own. The others, and those past
/// the frame, are nodata.
class Beyond {
public:
    absl::Status read(HeightSource& source, const PostRect& window,
                      const std::vector<Post>& around) {
        for (const PostRect& side : sidesOf(window, source.frame())) {
            const bool isAsked =
                side.columns > 0 && side.rows > 0 &&
                std::ranges::any_of(around, [&](const Post& post) { return isBeside(side, post); });
            if (!isAsked)
                continue;
            std::vector<float>& heights = heights_.emplace_back(
                static_cast<std::size_t>(side.columns) * static_cast<std::size_t>(side.rows));
            rects_.push_back(side);
            RETURN_IF_ERROR(source.read(side, heights.data()));
        }
        return absl::OkStatus();
    }

    bool hasData(std::int32_t i, std::int32_t j) const {
        for (std::size_t k = 0; k < rects_.size(); ++k)
            if (Heights{rects_[k], heights_[k]}.hasData(i, j))
                return true;
        return false;
    }

private:
    static bool isBeside(const PostRect& rect, const Post& post) {
        const auto [i, j] = post;
        return i >= rect.i - 1 && j >= rect.j - 1 && i <= rect.i + rect.columns &&
               j <= rect.j + rect.rows;
    }

    std::vector<PostRect> rects_;
    std::vector<std::vector<float>> heights_;
};

bool isWhole(std::span<const float> row) {
    int nodata = 0;
    for (const float height : row) nodata += height != height ? 1 : 0;
    return nodata == 0;
}

}  // namespace

absl::StatusOr<std::vector<std::size_t>> lonePostsOnBorder(HeightSource& source,
                                                           const PostRect& window,
                                                           const std::vector<float>& posts) {
    const Heights within{window, posts};
    const std::vector<Post> candidates = doubtful(within);
    Beyond beyond;
    RETURN_IF_ERROR(beyond.read(source, window, candidates));
    std::vector<std::size_t> lone;
    for (const auto& [i, j] : candidates) {
        const auto hasData = [&, i = i, j = j](int di, int dj) {
            return within.hasData(i + di, j + dj) || beyond.hasData(i + di, j + dj);
        };
        if (!hasGround(hasData))
            lone.push_back(within.placeOf(i - window.i, j - window.j));
    }
    return lone;
}

/// One after the other: no cell with three posts that have data loses one.
void dropLonePosts(const PostRect& window, const std::vector<std::size_t>& onBorder,
                   std::vector<float>& posts) {
    for (const std::size_t place : onBorder) posts[place] = terrain::kNodata;
    const auto columns = static_cast<std::size_t>(window.columns);
    const auto row = [&](std::int32_t v) {
        return std::span(posts).subspan(static_cast<std::size_t>(v) * columns, columns);
    };
    bool isWholeBefore = isWhole(row(0));
    for (std::int32_t v = 1; v < window.rows - 1; ++v) {
        const bool isWholeHere = isWhole(row(v));
        const bool haveGround = isWholeBefore && isWholeHere;
        isWholeBefore = isWholeHere;
        if (haveGround)
            continue;
        for (std::int32_t u = 1; u < window.columns - 1; ++u) {
            float* const post = row(v).data() + u;
            const auto hasData = [&](int di, int dj) {
                const float height = post[std::ptrdiff_t{dj} * window.columns + di];
                return height == height;
            };
            if (*post == *post && !hasGround(hasData))
                *post = terrain::kNodata;
        }
    }
}

}  // namespace eyrie::import
