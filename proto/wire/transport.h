// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace grpc {
class ChannelArguments;
class ServerBuilder;
}  // namespace grpc

/// How Eyrie's processes talk gRPC: the same limits and liveness checks at both ends.
namespace eyrie::wire {

/// Pixels travel in chunks of this size: measured, 1 MiB is the fastest both over TCP loopback and
/// Unix sockets, and three times as fast as one message of a whole picture.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// No message is larger, neither sent nor accepted, but for what a coordinator answers programs.
inline constexpr int kMaxMessageBytes = 4 << 20;

/// Of a connection to a coordinator or renderer: direct (no HTTP proxy), tried again within a
/// second, found dead after 3 seconds without an answer even if the network says nothing.
grpc::ChannelArguments clientArguments();

/// Of a server that such clients connect to. A port that another process listens on is an error
/// instead of being shared.
void configureServer(grpc::ServerBuilder& builder);

}  // namespace eyrie::wire
