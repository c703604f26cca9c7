// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <absl/status/statusor.h>

#include "cli/picture_source.h"
#include "cli/values.h"

namespace eyrie::cli {

/// Pixels of a band of a large picture: pictures up to 4K UHD are drawn at once.
inline constexpr std::int64_t kBandPixels = std::int64_t{3840} * 2160;

/// Of all that `request` asks for: its size is that of one eye, and two side by side, or one above
/// the other, are twice as wide or high.
PictureSize wholeSize(const coordinator::FrameRequest& request);

struct DrawnBands {
    /// Of all bands: counts and times add up, so a node in two bands counts twice; the error is the
    /// worst band's.
    fabric::FrameStatistics statistics;
    fabric::DeviceInfo device;
    std::string whyEmpty = {};  ///< coordinator::whyEmpty() where no band shows anything
    std::string whyBlind = {};  ///< why a part of one shows nothing
};

/// Draws what `request` asks for as bands of whole rows, from the top down, several at the same
/// time where `pictures` can, and gives each to `take`, one after the other. Together they are the
/// picture drawn at once, to the bit: a band is a part of the one view, as a renderer's is
/// (docs/decisions/0036-posters-by-bands.md). Of two eyes one above the other, the left eye's come
/// first, as what is above.
///
/// A band has as many rows as fit in `bandPixels`, and one at least. Errors: those of
/// PictureSource::draw and of `take`, after which nothing more is drawn.
absl::StatusOr<DrawnBands> drawInBands(
    PictureSource& pictures, const coordinator::FrameRequest& request, std::int64_t bandPixels,
    const std::function<absl::Status(const fabric::Image&)>& take);

}  // namespace eyrie::cli
