// SPDX-License-Identifier: Apache-2.0
#include "wire/listen.h"

#include <string>

#include <gmock/gmock.h>
#include <grpcpp/server.h>

#include "eyrie/v1/registry_service.grpc.pb.h"

namespace eyrie::wire {
namespace {

TEST(Listen, ReportsThePortThatWasChosen) {
    v1::RegistryService::Service service;
    const absl::StatusOr<Listening> listening = listen({"127.0.0.1:0"}, service);
    ASSERT_TRUE(listening.ok()) << listening.status();
    EXPECT_THAT(listening->addresses[0], testing::MatchesRegex("127\\.0\\.0\\.1:[1-9][0-9]*"));
}

TEST(Listen, APortInUseIsAnErrorThatNamesIt) {
    v1::RegistryService::Service service;
    const absl::StatusOr<Listening> first = listen({"127.0.0.1:0"}, service);
    ASSERT_TRUE(first.ok()) << first.status();
    v1::RegistryService::Service other;
    const absl::StatusOr<Listening> second = listen(first->addresses, other);
    EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
    EXPECT_THAT(std::string(second.status().message()), testing::HasSubstr(first->addresses[0]));
}

TEST(Listen, AnAddressHasAHostAndAPortOrAPath) {
    for (const char* good : {"127.0.0.1:0", "localhost:8080", "[::1]:65535", "unix:/run/eyrie/r0"})
        EXPECT_TRUE(checkAddress(good).ok()) << good;
    for (const char* bad : {"", "8080", ":8080", "localhost", "localhost:", "localhost:http",
                            "localhost:65536", "localhost:-1", "localhost:80x", "unix:"})
        EXPECT_EQ(checkAddress(bad).code(), absl::StatusCode::kInvalidArgument) << bad;
    EXPECT_THAT(std::string(checkAddress("unix:/" + std::string(107, 'x')).message()),
                testing::HasSubstr("108 bytes"));
}

}  // namespace
}  // namespace eyrie::wire
