// SPDX-License-Identifier: Apache-2.0
#include "tests/support/renderer_farm.h"

#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::test {

using coordinator::RendererCondition;

absl::StatusOr<std::unique_ptr<RendererFarm>> RendererFarm::start(
    const std::string& program, int renderers, coordinator::CoordinatorOptions options,
    std::vector<std::vector<std::string>> words) {
    std::unique_ptr<RendererFarm> farm(new RendererFarm(program));
    farm->words_ = std::move(words);
    options.grpcAddresses = {"unix:" + farm->folder_.path("c")};
    ASSIGN_OR_RETURN(farm->coordinator_, coordinator::Coordinator::start(options));
    farm->renderers_.resize(static_cast<std::size_t>(renderers));
    for (std::size_t i = 0; i < farm->renderers_.size(); ++i) farm->restart(i);
    return farm;
}

void RendererFarm::restart(std::size_t index) {
    Renderer& renderer = renderers_[index];
    renderer.address =
        fmt::format("unix:{}", folder_.path(fmt::format("r{}-{}", index, renderer.generation++)));
    std::vector<std::string> command = {
        program_,   "renderer",       "--coordinator", "unix:" + folder_.path("c"),
        "--listen", renderer.address, "--quiet"};
    if (index < words_.size())
        command.insert(command.end(), words_[index].begin(), words_[index].end());
    renderer.process =
        std::make_unique<Process>(command, std::vector<std::string>{"LP_NUM_THREADS=1"});
}

std::optional<RendererCondition> RendererFarm::conditionOf(
    std::size_t index, const coordinator::Status& status) const {
    for (const coordinator::RendererStatus& renderer : status.renderers)
        if (renderer.address == renderers_[index].address)
            return renderer.condition;
    return std::nullopt;
}

bool RendererFarm::awaitAllReady(std::chrono::milliseconds limit) {
    return eventually(limit, [this] {
        const coordinator::Status status = frames().status();
        for (std::size_t i = 0; i < renderers_.size(); ++i)
            if (conditionOf(i, status) != RendererCondition::Ready)
                return false;
        return status.problem.empty();
    });
}

}  // namespace eyrie::test
