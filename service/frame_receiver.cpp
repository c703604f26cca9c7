// SPDX-License-Identifier: Apache-2.0
#include "service/frame_receiver.h"

#include <utility>

#include <grpcpp/server_context.h>

#include "fabric/status.h"
#include "wire/picture_header.h"
#include "wire/status.h"

namespace eyrie::service {
namespace {

/// A picture lies somewhere in a view; the mailbox knows where it must.
constexpr fabric::PixelViewport kAnywhere{0, 0, fabric::kMaxViewPixels, fabric::kMaxViewPixels};

}  // namespace

void FrameReceiver::OnReadDone(bool ok) {
    const absl::Status status = ok ? take() : end();
    if (!ok || !status.ok())
        return Finish(wire::toGrpc(status));
    StartRead(&message_);
}

absl::Status FrameReceiver::take() {
    if (message_.has_header())
        return begin(message_.header());
    if (!pixels_)
        return absl::InvalidArgumentError("pixels came before their header");
    return pixels_->take(message_.chunk());
}

absl::Status FrameReceiver::begin(const v1::FrameHeader& header) {
    if (pixels_)
        return absl::InvalidArgumentError("a second header came amid a picture");
    RETURN_IF_ERROR(mailbox_.checkAddress(header.to()));
    ASSIGN_OR_RETURN(const wire::AnnouncedPicture picture,
                     wire::announcedPicture(header, kAnywhere, false));
    ASSIGN_OR_RETURN(
        Mailbox::Arrival arrival,
        mailbox_.admit({header.session(), header.frame_number(), header.frame()}, picture.area,
                       picture.hasDepth, [this] { context_.TryCancel(); }));
    arrival_.emplace(std::move(arrival));
    image_ = picture.blank();
    pixels_.emplace(image_, picture.encoding);
    return absl::OkStatus();
}

absl::Status FrameReceiver::end() {
    if (!pixels_)
        return absl::InvalidArgumentError("the stream ended before a header came");
    RETURN_IF_ERROR(pixels_->finish());
    arrival_->complete(std::move(image_));
    return absl::OkStatus();
}

}  // namespace eyrie::service
