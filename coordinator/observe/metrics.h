// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <absl/status/status.h>

#include "fabric/statistics.h"

namespace eyrie::access {
enum class Door;
struct Refusals;
}  // namespace eyrie::access

namespace eyrie::observe {

/// Where the time of a frame goes; docs/operations.md says what each is.
enum class Stage {
    Turn,     ///< waiting for the frame before
    Plan,     ///< from the configuration to channel tasks
    Render,   ///< tasks out, pictures in
    Compose,  ///< one picture of many
    Total,    ///< from the turn to the picture
    Cull,     ///< of the renderer that took longest, as are the next two
    Draw,
    Readback,
    Receive,  ///< of one channel: its pixels, from the header to the last
    Encode,   ///< for one browser
    Send,     ///< to one browser, until the system has taken it
};
std::string_view nameOf(Stage stage);
inline constexpr Stage kLastStage = Stage::Send;

/// What may be asked for only so much of; docs/security.md says how much.
enum class Quota { Image, Scene, Rate, Viewers, Readers, Operations, Documents };
std::string_view nameOf(Quota quota);
inline constexpr Quota kLastQuota = Quota::Documents;

enum class Peer { Http, WebSocket, Renderer };
enum class Direction { In, Out };

/// Numbers for Prometheus, counted since the process began. All functions may be called from any
/// thread. Every name and label is in docs/operations.md.
class Metrics {
public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    void frameMade(const fabric::FrameStatistics& statistics);
    void frameFailed();
    void frameCancelled();  ///< who had asked for it went away
    void took(Stage stage, std::chrono::duration<double> time);
    void bytes(Peer peer, Direction direction, std::size_t count);
    /// From a renderer: in memory that both see, or in messages.
    void pictureCame(bool inMemory);
    void viewers(int change);
    /// Pictures that screens behind a swap barrier have shown: all of them together, or without
    /// some that were too late.
    void swapped(int together, int cutShort);
    void taskReissued(bool wasLate);  ///< else the renderer before had failed
    void overQuota(Quota quota);      ///< a call, or a viewer, was refused for it
    /// A call of the API, by gRPC or HTTP; OK: none.
    void callFailed(absl::StatusCode code);
    /// An import or a bench run, as `status` says.
    void operationEnded(const absl::Status& status);
    /// By HTTP status, 400 or more; others are not counted.
    void refused(int status);
    /// What has been turned away so far at a door.
    void turnedAway(access::Door door, const access::Refusals& soFar);
    /// What a renderer has turned away at its own door since it last said so.
    void turnedAwayByRenderer(const access::Refusals& since);
    void handshakeFailed();  ///< somebody who wanted an encrypted connection, by HTTPS
    /// What the renderer at `address` holds for its scene.
    void rendererHolds(const std::string& address, std::uint64_t deviceBytes,
                       std::uint64_t hostBytes);

    /// In the text form that Prometheus scrapes. `renderers`: how many are in each condition.
    /// `ids`: of those that are there, by address, as they are told; what others hold is forgotten.
    std::string text(const std::map<std::string, int>& renderers,
                     const std::map<std::string, std::string>& ids);

    static constexpr std::string_view kContentType = "text/plain; version=0.0.4; charset=utf-8";

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::observe
