// SPDX-License-Identifier: Apache-2.0
#include "cli/awaited_renderers.h"

#include <algorithm>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::cli {
namespace {

using coordinator::RendererCondition;
using coordinator::RendererStatus;

/// One of ours that is refused, such as for data that it cannot open, stays so until others are
/// asked for. Those of other machines come and go.
absl::Status checkEnough(const AwaitedRenderers& awaited, const coordinator::Status& status) {
    const auto isRefused = [&](const RendererStatus& one) {
        return one.condition == RendererCondition::Refused &&
               one.address.starts_with(awaited.sockets);
    };
    const auto& all = status.renderers;
    const auto alive = std::ranges::count_if(all, &RendererStatus::isAlive);
    if (alive >= awaited.count || std::ranges::count_if(all, isRefused) + alive < awaited.started)
        return absl::OkStatus();
    const auto first = std::ranges::find_if(all, isRefused);
    if (first == all.end())
        return absl::OkStatus();
    return {first->code, fmt::format("{} renderer can draw this: {}",
                                     alive == 0 ? "no" : "not every", first->why)};
}

}  // namespace

int drawingRenderers(const coordinator::Status& status) {
    return static_cast<int>(std::ranges::count_if(status.renderers, [](const auto& one) {
        return one.condition == RendererCondition::Ready ||
               one.condition == RendererCondition::Late;
    }));
}

absl::StatusOr<bool> areThere(const AwaitedRenderers& awaited, const coordinator::Status& status) {
    if (drawingRenderers(status) >= awaited.count && status.problem.empty())
        return true;
    RETURN_IF_ERROR(checkEnough(awaited, status));
    return false;
}

}  // namespace eyrie::cli
