// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"

namespace eyrie::v1 {
class ChannelTask;
class FrameData;
class PixelViewport;
class Range;
}  // namespace eyrie::v1

/// Conversions of what frame.proto defines. Every fromMessage answers InvalidArgument, naming the
/// field, for what the value must not hold; what it returns is safe to compute with.
namespace eyrie::wire {

v1::FrameData toMessage(const fabric::FrameData& frameData);
absl::StatusOr<fabric::FrameData> fromMessage(const v1::FrameData& message);

/// Corner and size are from 0 to fabric::kMaxViewPixels; it may be empty.
v1::PixelViewport toMessage(const fabric::PixelViewport& viewport);
absl::StatusOr<fabric::PixelViewport> fromMessage(const v1::PixelViewport& message);

/// 0 <= begin <= end <= 1; it may be empty.
v1::Range toMessage(const fabric::Range& range);
absl::StatusOr<fabric::Range> fromMessage(const v1::Range& message);

/// The pixel viewport is not empty and lies inside the view, or its raster; sight and raster are
/// what fabric::validate() accepts. An absent range is the whole.
v1::ChannelTask toMessage(const fabric::ChannelTask& task);
absl::StatusOr<fabric::ChannelTask> fromMessage(const v1::ChannelTask& message);

}  // namespace eyrie::wire
