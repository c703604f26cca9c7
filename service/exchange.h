// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/channel_program.h"
#include "service/mailbox.h"
#include "service/peers.h"
#include "service/program_run.h"

namespace eyrie::service {

/// Channel programs, each on a thread of its own while it runs: it mostly waits. All functions may
/// be called from any thread.
class Exchange {
public:
    using Clock = std::chrono::steady_clock;
    using Done = std::function<void(absl::StatusOr<ProgramAnswer>)>;

    /// `thread` and `frameData` outlive the exchange.
    /// `security` is how this renderer shows itself to the others.
    Exchange(GlThread& thread, const FrameDataHistory& frameData,
             const wire::Security& security = {});

    /// Waits for programs in progress: stop them before.
    ~Exchange();
    Exchange(const Exchange&) = delete;
    Exchange& operator=(const Exchange&) = delete;

    /// Announces the program's inputs and begins it; `done` is called once, on its thread, unless
    /// this fails: ResourceExhausted when fabric::kMaxPrograms are running, what Mailbox::announce
    /// says.
    absl::Status start(fabric::ChannelProgram program, Clock::time_point deadline,
                       std::stop_token stop, Done done);

    /// Where other renderers' pictures are put.
    Mailbox& mailbox() { return mailbox_; }

private:
    struct Running {
        bool ended = false;
        std::thread thread;
    };

    absl::Status announceInputs(const fabric::ChannelProgram& program);
    void forget(const std::vector<FrameKey>& keys);
    void joinEnded();

    GlThread& thread_;
    const FrameDataHistory& frameData_;
    Mailbox mailbox_{Mailbox::Limits()};
    Peers peers_;
    std::mutex mutex_;  ///< guards running_
    std::list<Running> running_;
};

}  // namespace eyrie::service
