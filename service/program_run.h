// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>

#include <absl/status/statusor.h>

#include "fabric/channel_program.h"
#include "service/frame_data_history.h"
#include "service/gl_thread.h"
#include "service/mailbox.h"
#include "service/peers.h"

namespace eyrie::service {

/// What programs are carried out with.
struct ProgramTools {
    GlThread& thread;
    const FrameDataHistory& frameData;
    Mailbox& mailbox;
    Peers& peers;
};

struct ProgramAnswer {
    fabric::ProgramResult result;
    std::optional<DrawerMemory> memory;  ///< after the last draw; empty where there is none
};

/// Carries a program out, whose inputs have been announced: on the calling thread, which waits for
/// the GL thread, for pictures and for peers. Ends soon after `stop`, with Cancelled.
///
/// Errors: what drawing, Mailbox::await or Peers::send say, with the stage's number.
absl::StatusOr<ProgramAnswer> runProgram(const fabric::ChannelProgram& program,
                                         const ProgramTools& tools,
                                         std::chrono::steady_clock::time_point deadline,
                                         const std::stop_token& stop);

}  // namespace eyrie::service
