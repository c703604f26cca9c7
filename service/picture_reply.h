// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "eyrie/v1/render_service.pb.h"
#include "fabric/channel_program.h"
#include "service/reply_stream.h"
#include "wire/picture_bytes.h"

namespace eyrie::service {

/// The answer to RenderChannel: a header, then the pixels.
std::unique_ptr<MessageSource<v1::RenderChannelResponse>> channelReply(
    fabric::ChannelResult result, wire::PixelEncoding encoding);

/// The answer to RunProgram: each picture likewise, then the statistics.
std::unique_ptr<MessageSource<v1::RunProgramResponse>> programReply(fabric::ProgramResult result,
                                                                    wire::PixelEncoding encoding);

}  // namespace eyrie::service
