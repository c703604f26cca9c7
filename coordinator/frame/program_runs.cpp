// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/program_runs.h"

#include <chrono>
#include <future>
#include <iterator>
#include <stop_token>
#include <utility>

#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

/// How often what waits looks whether it is still wanted.
constexpr std::chrono::milliseconds kLookForStop{20};

fabric::ChannelProgram addressed(const compound::PlannedProgram& planned,
                                 const ProgramRuns::Setting& setting,
                                 const std::vector<std::string>& addresses) {
    fabric::ChannelProgram program = planned.program;
    program.session = setting.session;
    program.background = setting.background;
    std::size_t output = 0;
    for (fabric::ProgramStage& stage : program.stages) {
        if (stage.draw) {
            stage.draw->frameDataVersion = setting.frameData.version;
            stage.draw->completeness = setting.completeness;
            stage.draw->measuresStages = setting.measuresStages;
        }
        for (fabric::ProgramOutput& each : stage.outputs)
            if (const auto& taker = planned.takers[output++])
                each.to = addresses[*taker];
    }
    return program;
}

absl::Status prepareAll(const ProgramRuns::Setting& setting,
                        const std::vector<std::shared_ptr<Member>>& renderers) {
    std::vector<std::future<absl::Status>> prepared;
    for (const auto& one : renderers)
        prepared.push_back(one->prepare(setting.frameData, setting.sceneRevision, setting.timeout));
    const auto deadline = std::chrono::steady_clock::now() + setting.timeout;
    for (auto& one : prepared) {
        bool isReady = false;
        while (!isReady && !setting.stop.stop_requested() &&
               std::chrono::steady_clock::now() < deadline)
            isReady = one.wait_for(kLookForStop) == std::future_status::ready;
        if (setting.stop.stop_requested())
            return absl::CancelledError("nobody wants this frame any more");
        RETURN_IF_ERROR(isReady ? one.get()
                                : absl::DeadlineExceededError("a renderer has other work to do"));
    }
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ProgramRuns::Result> ProgramRuns::run(
    const compound::Exchange& exchange, const Setting& setting,
    const std::vector<std::shared_ptr<Member>>& renderers,
    const std::vector<std::string>& addresses) {
    std::vector<std::shared_ptr<void>> occupied;
    for (const auto& one : renderers) occupied.push_back(one->occupy());
    setting.handedOut();
    if (const absl::Status status = prepareAll(setting, renderers); !status.ok()) {
        occupied.clear();
        setting.freed();
        return status;
    }
    std::stop_source stop;
    const std::stop_callback unwanted(setting.stop, [&] { stop.request_stop(); });
    using Answer = absl::StatusOr<fabric::ProgramResult>;
    std::vector<std::future<Answer>> answers;
    for (std::size_t i = 0; i < exchange.programs.size(); ++i)
        answers.push_back(std::async(std::launch::async, [&, i]() -> Answer {
            Answer answer =
                renderers[i]->runProgram(addressed(exchange.programs[i], setting, addresses),
                                         setting.sceneRevision, setting.timeout, stop.get_token());
            occupied[i].reset();
            setting.freed();
            if (!answer.ok())
                stop.request_stop();
            return answer;
        }));
    Result result;
    result.device = renderers.front()->device();
    absl::Status failure;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        Answer answer = answers[i].get();
        if (!answer.ok()) {
            if (!absl::IsCancelled(answer.status()))
                failure.Update(answer.status());
            continue;
        }
        for (fabric::ProgramPicture& picture : answer->pictures)
            result.pictures.push_back(std::move(picture.image));
        for (std::size_t draw = 0; draw < answer->draws.size(); ++draw)
            result.draws.push_back(
                {exchange.programs[i].draws[draw], answer->draws[draw], renderers[i]->id()});
    }
    if (stop.stop_requested())
        return failure.ok() ? absl::CancelledError("the programs were ended") : failure;
    return result;
}

}  // namespace eyrie::coordinator
