// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

/// Between viewer.proto's bytes and values.
namespace eyrie::stream {

struct ViewRequest {
    std::uint64_t sequence = 0;
    coordinator::FrameRequest frame;
    bool isUnderground = false;  ///< the camera may be under ground
};

struct FrameAck {
    std::uint64_t frameNumber = 0;
};

/// A question of what a place of a picture shows.
struct ViewerPick {
    std::uint64_t sequence = 0;
    absl::StatusOr<fabric::PickRequest> request;  ///< or what is wrong with it
};

inline constexpr int kMinPictureSide = 16;
inline constexpr int kMaxPictureSide = 4096;

/// Sizes are clamped to kMinPictureSide..kMaxPictureSide.
/// Errors: InvalidArgument (a view that cannot be drawn; the message tells the user why), DataLoss
/// (not a ViewerRequest: the sender does not speak this protocol).
/// A pick that cannot be made is parsed, with what is wrong: it has an answer of its own.
absl::StatusOr<std::variant<ViewRequest, FrameAck, ViewerPick>> parseRequest(
    std::span<const std::byte> bytes);

/// A ViewerResponse with a SessionState. `problem` goes before status.problem.
std::string stateMessage(const coordinator::Status& status, std::string_view problem);

struct EncodedFrame {
    std::uint64_t frameNumber = 0;
    std::uint64_t viewSequence = 0;
    bool isStill = false;
    std::span<const std::byte> jpeg;
    std::optional<fabric::Camera> liftedCamera = {};  ///< shown in place of the one asked for
};

/// A ViewerResponse with a Frame: `encoded` of what `rendered` shows.
std::string frameMessage(const EncodedFrame& encoded, const coordinator::RenderedFrame& rendered);

/// A ViewerResponse with a ViewerPicked.
std::string pickedMessage(std::uint64_t sequence, const absl::StatusOr<fabric::Picked>& picked);

/// `text` fit for a message to a person: valid UTF-8 without control characters, one line of at
/// most 400 bytes.
std::string sanitised(std::string_view text);

}  // namespace eyrie::stream
