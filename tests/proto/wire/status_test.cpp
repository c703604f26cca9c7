// SPDX-License-Identifier: Apache-2.0
#include "wire/status.h"

#include <gmock/gmock.h>
#include <grpcpp/support/status.h>

namespace eyrie::wire {
namespace {

TEST(WireStatus, CodeAndMessageCrossTheWire) {
    for (int code = 1; code <= 16; ++code) {
        const absl::Status status(static_cast<absl::StatusCode>(code), "eyes.json: no target");
        const absl::Status back = fromGrpc(toGrpc(status), "renderer");
        EXPECT_EQ(back.code(), status.code());
        EXPECT_EQ(std::string(back.message()), "renderer: eyes.json: no target");
    }
    EXPECT_TRUE(fromGrpc(toGrpc(absl::OkStatus()), "renderer").ok());
}

TEST(WireStatus, DataHaveTheNamesThatAnybodyMaySee) {
    const absl::Status status = absl::NotFoundError("http://joe:sekret@h/a.eyt?sig=S: it is gone");
    EXPECT_EQ(toGrpc(status).error_message(), "http://…@h/a.eyt?…: it is gone");
}

TEST(WireStatus, ACodeOutsideTheListIsUnknown) {
    const grpc::Status odd(grpc::StatusCode::DO_NOT_USE, "odd");
    EXPECT_EQ(fromGrpc(odd, "renderer").code(), absl::StatusCode::kUnknown);
}

TEST(WireStatus, AMessageFitsAHeader) {
    const grpc::Status status = toGrpc(absl::InternalError(std::string(100'000, 'x')));
    EXPECT_EQ(status.error_message().size(), 4096);
}

}  // namespace
}  // namespace eyrie::wire
