// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/session.h"

#include <utility>

#include "coordinator/stream/session_impl.h"

namespace eyrie::stream {

Session::Session(coordinator::FrameSource& frames, std::string name, const SessionOptions& options,
                 std::string id)
    : impl_(std::make_unique<Impl>(frames, std::move(name), options, std::move(id))) {}
Session::~Session() = default;

std::shared_ptr<Seat> Session::join(Role role, bool mayControl, const std::string& viewer,
                                    std::function<void()> messageReady) {
    return impl_->join(role, mayControl, viewer, std::move(messageReady));
}
void Session::show(Seat& seat, OwnScreen screen) { impl_->show(seat, std::move(screen)); }
void Session::ready(Seat& seat, std::uint64_t swap) { impl_->ready(seat, swap); }
bool Session::leave(const std::shared_ptr<Seat>& seat) { return impl_->leave(seat); }
void Session::want(Seat& seat, const ViewRequest& view) { impl_->want(seat, view); }
void Session::takeLead(Seat& seat) { impl_->takeLead(seat); }
void Session::switchLayout(Seat& seat, coordinator::SwitchLayout change) {
    impl_->switchLayout(seat, std::move(change));
}
void Session::acknowledged(Seat& seat, const FrameAck& ack) { impl_->acknowledged(seat, ack); }
void Session::able(Seat& seat, const Abilities& abilities) { impl_->able(seat, abilities); }
void Session::refuse(Seat& seat, const absl::Status& why) { impl_->refuse(seat, why); }
void Session::roundTrip(Seat& seat, Clock::duration time) { impl_->roundTrip(seat, time); }
std::optional<std::string> Session::take(Seat& seat) { return impl_->take(seat); }
std::optional<Clock::duration> Session::unacknowledgedFor(Seat& seat) {
    return impl_->unacknowledgedFor(seat);
}
void Session::drain() { impl_->drain(); }
bool Session::hasDrained(Seat& seat) { return impl_->hasDrained(seat); }
SessionCounts Session::counts() const { return impl_->counts(); }
const std::string& Session::name() const { return impl_->name(); }
const std::string& Session::id() const { return impl_->id(); }
SessionFacts Session::facts() const { return impl_->facts(); }
absl::Status Session::change(const ViewChange& change) { return impl_->change(change); }
void Session::close() { impl_->close(); }
bool Session::isClosed() const { return impl_->isClosed(); }
bool Session::hasViewers() const { return impl_->hasViewers(); }

}  // namespace eyrie::stream
