// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "fabric/range.h"
#include "fabric/regridding.h"
#include "fabric/viewport.h"

namespace eyrie::compound {

/// Something that was drawn: where, of which data, and on which of the pixels there.
struct Content {
    fabric::PixelViewport area;
    fabric::Range range;
    std::optional<fabric::Regridding> everyNth;
    bool isFull = true;  ///< all data of the range is there, on all of those pixels
};

/// A part of a picture, and of the data there, that is not there.
struct Gap {
    fabric::PixelViewport area;
    fabric::Range range;
    double ofPixels = 1;  ///< the share of them that it is about
};

/// What is on a picture that is being put together.
class Contents {
public:
    /// The range around all that `content` would meet; nothing where it meets nothing.
    std::optional<fabric::Range> met(const Content& content) const;

    /// The range around all; nothing where there is nothing.
    std::optional<fabric::Range> range() const;

    /// Whether all data of `range` is there in all of `area`. False, too, where finding out takes
    /// long.
    bool cover(const fabric::PixelViewport& area, const fabric::Range& range) const;

    /// Parts of `area` where nothing is of some of the data, or on some of the pixels: apart from
    /// each other, and only what is surely missing. What is not full counts as there. Nothing where
    /// finding out takes long.
    std::vector<Gap> gaps(const fabric::PixelViewport& area) const;

    /// Whether somewhere some of the data is there and some is not. False, too, where finding out
    /// takes long.
    bool hasOnlyPartOfTheData() const;

    /// When all shares of a rectangle's columns and rows are there, they count as the rectangle.
    void add(const Content& content);

    /// Forgets what lies in `area`; where finding out takes long, only what lies there with all of
    /// it.
    void clear(const fabric::PixelViewport& area);

    Contents within(const fabric::PixelViewport& area) const;

    const std::vector<Content>& all() const { return all_; }

private:
    std::vector<Content> all_;
};

}  // namespace eyrie::compound
