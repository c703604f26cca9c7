// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/compound/work.h"

namespace eyrie::compound {

/// From the pixels of a framebuffer to those of a frame that it takes.
struct FrameMapping {
    std::vector<fabric::Regridding> regriddings;
    std::int32_t fromX = 0;  ///< of the frame, what counts as pixel 0 behind them
    std::int32_t fromY = 0;

    bool isIdentity() const { return regriddings.empty() && fromX == 0 && fromY == 0; }

    /// At least what a part of the frame covers in the framebuffer.
    fabric::PixelViewport covered(const fabric::PixelViewport& part) const {
        return regriddings.empty() ? part : regriddings.front().of;
    }

    /// Where only every n-th pixel is taken.
    std::optional<fabric::Regridding> everyNth() const {
        if (regriddings.size() == 1 &&
            regriddings.front().kind == fabric::Regridding::Kind::EveryNth)
            return regriddings.front();
        return std::nullopt;
    }
};

/// Within a destination: the steps that lead from the framebuffer's pixels to the frame's. Between
/// destinations, such as those of a monitor: what both show of a view, to scale. From there an
/// input with a placing is moved, so that the picture it is a part of begins at the placing's, and
/// gets as many pixels for each of its own as that says.
/// Nothing where no steps lead there.
std::optional<FrameMapping> mappingOf(const config::ResolvedConfiguration& resolved,
                                      const WorkList& list, const Input& input,
                                      std::size_t framebuffer);

}  // namespace eyrie::compound
