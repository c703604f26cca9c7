// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"
#include "coordinator/stream/profile.h"
#include "coordinator/stream/view_message.h"

namespace eyrie::v1 {
class SessionState;
}

/// Between viewer.proto's bytes and values.
namespace eyrie::stream {

struct FrameAck {
    std::uint64_t frameNumber = 0;
    /// Bytes of its picture that have arrived, where it comes in parts; absent: it was drawn.
    std::optional<std::uint64_t> receivedBytes = {};
    std::chrono::duration<double> decoding{0};  ///< from its arrival until it was drawn
};

/// A question of what a place of a picture shows.
struct ViewerPick {
    std::uint64_t sequence = 0;
    absl::StatusOr<fabric::PickRequest> request;  ///< or what is wrong with it
};

/// A question of heights along a line.
struct ViewerProfile {
    std::uint64_t sequence = 0;
    absl::StatusOr<ProfileLine> line;  ///< or what is wrong with it
};

/// Takes the lead of the session.
struct TakeLead {};

/// What a browser can show beside JPEG and PNG.
struct Abilities {
    bool h264 = false;
    bool tiles = false;  ///< pictures that are several JPEGs
};

/// Which picture a viewer shows, whoever leads.
struct OwnScreen {
    std::optional<coordinator::Shown> shown;  ///< nothing: what the leader asks for
};

/// The picture of that swap has been decoded.
struct SwapReady {
    std::uint64_t swap = 0;
};

/// How near to the server's picture one is sent.
enum class Fineness {
    Moving,  ///< JPEG or H.264, as the link allows
    Fine,    ///< JPEG of quality 95, 4:4:4
    Exact,   ///< PNG, bit for bit
};

/// Errors: InvalidArgument (a view that cannot be drawn; the message tells the user why), DataLoss
/// (not a ViewerRequest: the sender does not speak this protocol).
/// A pick or profile that cannot be made is parsed, with what is wrong: it has an answer of its
/// own.
using Request = std::variant<ViewRequest, FrameAck, ViewerPick, ViewerProfile,
                             coordinator::SwitchLayout, TakeLead, Abilities, OwnScreen, SwapReady>;
absl::StatusOr<Request> parseRequest(std::span<const std::byte> bytes);

/// A viewer among those that see the same.
struct Place {
    std::string session;       ///< empty: it is alone
    int viewers = 1;           ///< this one among them
    bool leads = true;         ///< this one moves the view
    bool isLed = true;         ///< somebody does
    bool mayControl = false;   ///< this one may take the lead, and switch layouts
    std::string barrier = {};  ///< that it shows its pictures behind, with others; empty: none
    int together = 0;          ///< those behind it, this one among them
    int behind = 0;            ///< those of them that are not waited for
};

v1::SessionState sessionState(const coordinator::Status& status, std::string_view problem);

/// A ViewerResponse with that and `place`. `problem` goes before status.problem, `refusal` before
/// status.note, and `note` after that.
std::string stateMessage(const coordinator::Status& status, std::string_view problem,
                         std::string_view refusal, std::string_view note, const Place& place);

/// Where in which stream of H.264 a picture is.
struct VideoPlace {
    std::uint64_t stream = 0;   ///< from 1, in its session
    std::uint64_t picture = 0;  ///< from 1, in the stream
    bool isKey = false;         ///< it needs none before it

    bool operator==(const VideoPlace&) const = default;
};

/// One of the JPEGs that a picture is laid out of, by its upper left corner.
struct JpegTile {
    int x = 0;  ///< pixels, from the picture's left
    int y = 0;  ///< and from its top
    std::size_t bytes = 0;

    bool operator==(const JpegTile&) const = default;
};

/// A picture as browsers get it, for all whose links are alike.
struct EncodedPicture {
    Fineness fineness = Fineness::Moving;
    int quality = 0;  ///< of a JPEG
    int width = 0;    ///< pixels
    int height = 0;
    std::vector<std::byte> bytes;          ///< a PNG where it is Exact, else JPEGs or H.264
    std::vector<JpegTile> tiles = {};      ///< one after the other in `bytes`; empty: it is one
    std::uint32_t pixelHash = 0;           ///< fabric::pixelHash, where it is Exact
    std::optional<VideoPlace> video = {};  ///< of H.264
};

/// The same for one of them.
struct EncodedFrame {
    std::uint64_t frameNumber = 0;
    std::uint64_t viewSequence = 0;
    std::shared_ptr<const EncodedPicture> picture;
    std::optional<fabric::Camera> liftedCamera = {};  ///< shown in place of the one asked for
    std::optional<fabric::Vec3> lift = {};            ///< of an eye that may be under ground
    std::optional<ViewRequest> ledView = {};          ///< that another viewer asked for
    double linkBytesPerSecond = 0;                    ///< 0: not known
    std::size_t output = 0;                           ///< in RenderedFrame::pictures
    std::uint64_t swap = 0;                           ///< that it waits for; 0: it is shown at once
};

/// A ViewerResponse with a Frame: `encoded` of what `rendered` shows, with the first `bytes` of its
/// picture.
std::string frameMessage(const EncodedFrame& encoded, const coordinator::RenderedFrame& rendered,
                         std::size_t bytes);

/// A ViewerResponse with a FramePart: `bytes` of a picture from `offset` on.
std::string framePartMessage(std::uint64_t frameNumber, std::size_t offset,
                             std::span<const std::byte> bytes);

/// A ViewerResponse with a ViewerSwap.
std::string swapMessage(std::uint64_t swap);

/// A ViewerResponse with a ViewerPicked.
std::string pickedMessage(std::uint64_t sequence, const absl::StatusOr<fabric::Picked>& picked);

/// A ViewerResponse with a ViewerProfiled.
std::string profiledMessage(std::uint64_t sequence,
                            const absl::StatusOr<std::vector<fabric::Picked>>& samples);

/// `text` fit for a message to a person: valid UTF-8 without control characters, one line of at
/// most 400 bytes.
std::string sanitised(std::string_view text);

}  // namespace eyrie::stream
