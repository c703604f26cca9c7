// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer.h"

#include <type_traits>
#include <utility>
#include <variant>

#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

Viewer::Viewer(Sessions& sessions, const Joining& joining,
               const std::function<void()>& messageReady)
    : sessions_(sessions),
      joined_(sessions.join(joining, messageReady)),
      picks_(sessions.frames(), messageReady) {}

Viewer::~Viewer() {
    stop();
    joined_.seat->close();
}

absl::Status Viewer::receive(std::span<const std::byte> message) {
    auto request = parseRequest(message);
    if (absl::IsDataLoss(request.status()))
        return request.status();
    const auto& session = joined_.session;
    const auto& seat = joined_.seat;
    if (!request.ok()) {
        session->refuse(*seat, request.status());
        return absl::OkStatus();
    }
    std::visit(
        [&](auto&& one) {
            using Kind = std::decay_t<decltype(one)>;
            if constexpr (std::is_same_v<Kind, ViewRequest>)
                session->want(*seat, one);
            else if constexpr (std::is_same_v<Kind, FrameAck>)
                session->acknowledged(*seat, one);
            else if constexpr (std::is_same_v<Kind, coordinator::SwitchLayout>)
                session->switchLayout(*seat, std::move(one));
            else if constexpr (std::is_same_v<Kind, TakeLead>)
                session->takeLead(*seat);
            else if constexpr (std::is_same_v<Kind, Abilities>)
                session->able(*seat, one);
            else if constexpr (std::is_same_v<Kind, OwnScreen>)
                session->show(*seat, std::move(one));
            else if constexpr (std::is_same_v<Kind, SwapReady>)
                session->ready(*seat, one.swap);
            else if (!isDraining_)
                picks_.ask(std::move(one));
        },
        *std::move(request));
    return absl::OkStatus();
}

std::optional<std::string> Viewer::takeMessage() {
    // Answers to picks, like states, are small and never wait for pictures.
    if (std::optional<std::string> answer = picks_.takeAnswer())
        return answer;
    return joined_.session->take(*joined_.seat);
}

void Viewer::roundTrip(std::chrono::steady_clock::duration time) {
    joined_.session->roundTrip(*joined_.seat, time);
}

std::optional<std::chrono::steady_clock::duration> Viewer::unacknowledgedFor() const {
    return joined_.session->unacknowledgedFor(*joined_.seat);
}

void Viewer::drain() {
    isDraining_ = true;
    joined_.session->drain();
}

bool Viewer::hasDrained() const { return joined_.session->hasDrained(*joined_.seat); }

void Viewer::stop() {
    sessions_.leave(joined_);
    picks_.stop();
}

}  // namespace eyrie::stream
