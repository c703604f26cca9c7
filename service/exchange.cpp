// SPDX-License-Identifier: Apache-2.0
#include "service/exchange.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::service {
namespace {

/// Of all inputs.
std::vector<FrameKey> keysOf(const fabric::ChannelProgram& program) {
    std::vector<FrameKey> keys;
    for (const fabric::ProgramStage& stage : program.stages)
        for (const fabric::ProgramInput& input : stage.inputs)
            keys.push_back({program.session, program.frameNumber, input.frame});
    return keys;
}

}  // namespace

Exchange::Exchange(GlThread& thread, const FrameDataHistory& frameData,
                   const wire::Security& security)
    : thread_(thread), frameData_(frameData), peers_(security) {}

Exchange::~Exchange() {
    for (Running& running : running_) running.thread.join();
}

absl::Status Exchange::start(fabric::ChannelProgram program, Clock::time_point deadline,
                             std::stop_token stop, Done done) {
    const std::lock_guard lock(mutex_);
    joinEnded();
    if (running_.size() >= fabric::kMaxPrograms)
        return absl::ResourceExhaustedError(
            fmt::format("{} channel programs are running already", fabric::kMaxPrograms));
    RETURN_IF_ERROR(announceInputs(program));
    Running& running = running_.emplace_back();
    running.thread = std::thread([this, &running, program = std::move(program), deadline,
                                  stop = std::move(stop), done = std::move(done)] {
        absl::StatusOr<ProgramAnswer> answer =
            runProgram(program, {thread_, frameData_, mailbox_, peers_}, deadline, stop);
        forget(keysOf(program));
        done(std::move(answer));
        const std::lock_guard ending(mutex_);
        running.ended = true;
    });
    return absl::OkStatus();
}

absl::Status Exchange::announceInputs(const fabric::ChannelProgram& program) {
    std::vector<FrameKey> announced;
    for (const fabric::ProgramStage& stage : program.stages)
        for (const fabric::ProgramInput& input : stage.inputs) {
            const FrameKey key{program.session, program.frameNumber, input.frame};
            const absl::Status status =
                mailbox_.announce(key, input.area, input.merge != fabric::Merge::Paste);
            if (!status.ok()) {
                forget(announced);
                return status;
            }
            announced.push_back(key);
        }
    return absl::OkStatus();
}

void Exchange::forget(const std::vector<FrameKey>& keys) {
    for (const FrameKey& key : keys) mailbox_.forget(key);
}

void Exchange::joinEnded() {
    for (Running& running : running_)
        if (running.ended)
            running.thread.join();
    std::erase_if(running_, [](const Running& running) { return running.ended; });
}

}  // namespace eyrie::service
