// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/handlers.h"

#include <new>

#include <fmt/format.h>

#include "coordinator/stream/viewer_messages.h"
#include "fabric/log.h"

namespace eyrie::api {

absl::StatusOr<std::unique_ptr<MessageStream>> Handlers::open(std::string_view name,
                                                              const Message& request) const {
    const auto found = streams_.find(name);
    if (found == streams_.end())
        return absl::UnimplementedError(fmt::format("this server has no {}", name));
    return found->second(request);
}

absl::Status Handlers::handle(std::string_view name, const Message& request, Message& response,
                              const Call& call) const {
    const auto found = table_.find(name);
    if (found == table_.end())
        return absl::UnimplementedError(fmt::format("this server has no {}", name));
    if (call.stop.stop_requested())
        return absl::CancelledError("the caller has gone");
    try {
        return found->second(request, response, call);
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            "there is no memory for the answer; ask for less at a time");
    }
}

void Handlers::note(std::string_view name, const absl::Status& status) const {
    if (telemetry_ != nullptr)
        telemetry_->metrics.callFailed(status.code());
    const bool isOurs = absl::IsUnavailable(status) || absl::IsDataLoss(status) ||
                        absl::IsInternal(status) || absl::IsUnknown(status);
    if (!isOurs)
        return;
    if (told_.isDue(fmt::format("{} {}", name, static_cast<int>(status.code())),
                    access::RareWarnings::Clock::now()))
        spdlog::warn("{} cannot be answered: {}; more such within a minute are not told", name,
                     stream::sanitised({status.message().data(), status.message().size()}));
}

}  // namespace eyrie::api
