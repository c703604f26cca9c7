// SPDX-License-Identifier: Apache-2.0
#include "wire/status.h"

#include <string_view>

#include <fmt/format.h>
#include <grpcpp/support/status.h>

#include "fabric/shown_name.h"

namespace eyrie::wire {
namespace {

constexpr std::size_t kMaxMessageBytes = 4096;

}  // namespace

grpc::Status toGrpc(const absl::Status& status) {
    if (status.ok())
        return grpc::Status::OK;
    const std::string message =
        fabric::shownName({status.message().data(), status.message().size()});
    return {static_cast<grpc::StatusCode>(status.code()), message.substr(0, kMaxMessageBytes)};
}

absl::Status fromGrpc(const grpc::Status& status, const std::string& peer) {
    if (status.ok())
        return absl::OkStatus();
    const int code = status.error_code();
    const bool known = code > 0 && code <= static_cast<int>(absl::StatusCode::kUnauthenticated);
    return {known ? static_cast<absl::StatusCode>(code) : absl::StatusCode::kUnknown,
            fmt::format("{}: {}", peer, status.error_message())};
}

}  // namespace eyrie::wire
