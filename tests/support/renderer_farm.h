// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/coordinator.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// A coordinator in this process, with renderer processes of this machine, over Unix sockets in a
/// folder of its own. Processes end with the thread that started them.
class RendererFarm {
public:
    /// `program` is the path of `eyrie`. Where the renderers register is chosen here, whatever
    /// `options` say. `words` are further options of each renderer's; none for those without.
    static absl::StatusOr<std::unique_ptr<RendererFarm>> start(
        const std::string& program, int renderers, coordinator::CoordinatorOptions options,
        std::vector<std::vector<std::string>> words = {});

    coordinator::Coordinator& coordinator() { return *coordinator_; }
    coordinator::FrameSource& frames() { return coordinator_->frames(); }

    int size() const { return static_cast<int>(renderers_.size()); }
    Process& renderer(std::size_t index) { return *renderers_[index].process; }
    /// As a new process at a new address; the one before is killed where it still runs.
    void restart(std::size_t index);
    /// In `status`; nothing where it is not listed.
    std::optional<coordinator::RendererCondition> conditionOf(
        std::size_t index, const coordinator::Status& status) const;

    /// True once all renderers draw.
    bool awaitAllReady(std::chrono::milliseconds limit);

private:
    struct Renderer {
        std::string address;
        std::unique_ptr<Process> process;
        int generation = 0;
    };

    explicit RendererFarm(std::string program) : program_(std::move(program)) {}

    const std::string program_;
    TemporaryFolder folder_;
    std::unique_ptr<coordinator::Coordinator> coordinator_;
    std::vector<Renderer> renderers_;
    std::vector<std::vector<std::string>> words_;
};

}  // namespace eyrie::test
