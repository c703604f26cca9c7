// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/session_message.h"

#include <chrono>

#include "coordinator/stream/session.h"
#include "coordinator/stream/statistics_message.h"
#include "coordinator/stream/view_message.h"

namespace eyrie::api {
namespace {

std::int64_t unixMilliseconds(std::chrono::system_clock::time_point time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
}

v1::PictureCodec codecOf(stream::SentAs as) {
    switch (as) {
        case stream::SentAs::Jpeg:
            return v1::PICTURE_CODEC_JPEG;
        case stream::SentAs::Png:
            return v1::PICTURE_CODEC_PNG;
        case stream::SentAs::H264:
            return v1::PICTURE_CODEC_H264;
        case stream::SentAs::Nothing:
            break;
    }
    return v1::PICTURE_CODEC_UNSPECIFIED;
}

v1::SessionViewer messageOf(const stream::ViewerFacts& viewer) {
    v1::SessionViewer message;
    message.set_id(viewer.id);
    message.set_joined_unix_milliseconds(unixMilliseconds(viewer.joined));
    message.set_leads(viewer.leads);
    message.set_watches(viewer.role == stream::Role::Watch);
    message.set_may_control(viewer.mayControl);
    message.set_width(viewer.last.width);
    message.set_height(viewer.last.height);
    message.set_codec(codecOf(viewer.last.as));
    message.set_pictures_sent(viewer.given);
    message.set_link_bytes_per_second(viewer.bytesPerSecond.value_or(0));
    return message;
}

}  // namespace

v1::Session sessionMessage(const stream::Session& session) {
    const stream::SessionFacts facts = session.facts();
    v1::Session message;
    message.set_id(session.id());
    message.set_created_unix_milliseconds(unixMilliseconds(facts.created));
    for (const stream::ViewerFacts& viewer : facts.viewers)
        *message.add_viewers() = messageOf(viewer);
    if (facts.view)
        *message.mutable_view() = stream::toMessage(*facts.view);
    if (facts.frame != nullptr) {
        const fabric::PixelViewport& area = facts.frame->image.area;
        *message.mutable_statistics() =
            stream::statisticsMessage(*facts.frame, area.width, area.height);
    }
    message.set_frames_drawn(facts.counts.drawn);
    message.set_pictures_encoded(facts.counts.encoded);
    message.set_pictures_sent(facts.counts.given);
    return message;
}

}  // namespace eyrie::api
