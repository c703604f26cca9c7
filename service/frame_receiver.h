// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <grpcpp/support/server_callback.h>

#include "eyrie/v1/render_service.pb.h"
#include "service/mailbox.h"
#include "wire/picture_bytes.h"

namespace eyrie::service {

/// One PutFrame call: takes a picture into the mailbox. Nothing is allocated before the mailbox has
/// admitted it. Owns itself, as gRPC's reactors do.
class FrameReceiver final : public grpc::ServerReadReactor<v1::PutFrameRequest> {
public:
    /// `mailbox` outlives the call, of which `context` is.
    FrameReceiver(Mailbox& mailbox, grpc::CallbackServerContext& context)
        : mailbox_(mailbox), context_(context) {
        StartRead(&message_);
    }

    void OnReadDone(bool ok) override;
    void OnDone() override { delete this; }

private:
    absl::Status take();
    absl::Status begin(const v1::FrameHeader& header);
    absl::Status end();

    Mailbox& mailbox_;
    grpc::CallbackServerContext& context_;
    v1::PutFrameRequest message_;
    std::optional<Mailbox::Arrival> arrival_;  ///< once there is a header
    fabric::Image image_;
    std::optional<wire::PictureReader> pixels_;
};

}  // namespace eyrie::service
