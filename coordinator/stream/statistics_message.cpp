// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/statistics_message.h"

#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/statistics.pb.h"
#include "wire/statistics.h"

namespace eyrie::stream {
namespace {

v1::PartStatistics toMessage(const coordinator::DrawnPart& part) {
    v1::PartStatistics message;
    message.set_renderer(sanitised(part.renderer));
    message.set_left(part.left);
    message.set_bottom(part.bottom);
    message.set_width(part.width);
    message.set_height(part.height);
    message.set_range_begin(part.range.begin);
    message.set_range_end(part.range.end);
    message.set_milliseconds(part.milliseconds);
    message.set_triangles(part.triangles);
    return message;
}

}  // namespace

v1::FrameStatistics statisticsMessage(const coordinator::RenderedFrame& frame, int width,
                                      int height) {
    v1::FrameStatistics message = wire::toMessage(frame.statistics);
    message.set_width(width);
    message.set_height(height);
    *message.mutable_renderer() = wire::toMessage(frame.device);
    for (const coordinator::DrawnPart& part : frame.parts) *message.add_parts() = toMessage(part);
    return message;
}

}  // namespace eyrie::stream
