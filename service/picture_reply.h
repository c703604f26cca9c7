// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "eyrie/v1/render_service.pb.h"
#include "service/channel_drawer.h"
#include "service/program_run.h"
#include "service/reply_stream.h"
#include "wire/picture_bytes.h"

namespace eyrie::service {

/// How a channel came about, for whoever wants to know where its time went.
struct ChannelStory {
    using Clock = std::chrono::steady_clock;

    Clock::time_point received;
    Clock::time_point begun;
    Clock::time_point drawn;
    DrawerMemory memory;
};

/// The answer to RenderChannel where the pixels are in the caller's memory, whatever of them the
/// result has: a header.
std::unique_ptr<MessageSource<v1::RenderChannelResponse>> replyInMemory(
    const fabric::ChannelResult& result, bool hasDepth, const ChannelStory& story);

/// Where they are not: a header, then the pixels.
std::unique_ptr<MessageSource<v1::RenderChannelResponse>> channelReply(fabric::ChannelResult result,
                                                                       wire::PixelEncoding encoding,
                                                                       const ChannelStory& story);

/// The same as a JPEG, as the task allows it: a header, then the JPEG of all of its pixel viewport,
/// encoded by the thread that sends, not by the one that draws. What nothing was drawn to is
/// `background`.
std::unique_ptr<MessageSource<v1::RenderChannelResponse>> jpegReply(fabric::ChannelResult result,
                                                                    const fabric::ChannelTask& task,
                                                                    fabric::Rgba background,
                                                                    const ChannelStory& story);

/// The answer to RunProgram: each picture likewise, then the statistics.
std::unique_ptr<MessageSource<v1::RunProgramResponse>> programReply(ProgramAnswer answer,
                                                                    wire::PixelEncoding encoding);

}  // namespace eyrie::service
