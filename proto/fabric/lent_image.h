// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "fabric/image.h"

namespace eyrie::fabric {

/// An image that is one's own, or lies in memory that somebody lends until it has been used: of
/// that a copy is made when, and only if, it is to be changed or kept.
class LentImage {
public:
    LentImage() = default;
    LentImage(Image image) : own_(std::move(image)) {}
    /// `pixels` are there until `lender` and all of its copies are gone. They may be changed by
    /// others meanwhile, but what was copied is not.
    LentImage(const ImageView& pixels, std::shared_ptr<const void> lender)
        : lent_(pixels), lender_(std::move(lender)) {}

    /// No longer than this is there and nobody asks for own().
    ImageView view() const { return lender_ != nullptr ? lent_ : ImageView(own_); }
    const PixelViewport& area() const { return lender_ != nullptr ? lent_.area : own_.area; }
    bool hasDepth() const { return view().hasDepth(); }
    bool isEmpty() const { return area().isEmpty(); }

    /// To be changed, or moved away.
    Image& own() {
        if (const auto lender = std::exchange(lender_, nullptr))
            own_ = copied(lent_);
        return own_;
    }

private:
    Image own_;
    ImageView lent_;
    std::shared_ptr<const void> lender_;  ///< null: it is own_
};

}  // namespace eyrie::fabric
