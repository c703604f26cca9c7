// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/late_close.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>

namespace eyrie::http {
namespace {

using boost::beast::error_code;

/// More than anybody should send.
constexpr std::uint64_t kMaxDroppedBytes = std::uint64_t{256} * 1024 * 1024;

class LateClose : public Session, public std::enable_shared_from_this<LateClose> {
public:
    LateClose(Stream stream, Context& context, Slot slot)
        : stream_(std::move(stream)),
          patience_(stream_.get_executor()),
          context_(context),
          slot_(std::move(slot)) {
        stream_.expires_never();
        context_.sessions.insert(this);
    }

    ~LateClose() override {
        context_.sessions.erase(this);
        context_.sessionEnded();
    }

    void begin(const std::string& address) {
        context_.crowd.await(waiting_, address, [this] {
            waiting_.end();
            slot_.reset();
            stream_.close();
        });
        patience_.expires_after(context_.options.headerTimeout);
        patience_.async_wait([weak = weak_from_this()](error_code error) {
            if (const auto self = weak.lock(); self && !error)
                self->stream_.close();
        });
        drop();
    }

    void shutDown() override { stream_.close(); }
    void abandon() override {}

private:
    /// Not decrypted: nobody looks at it.
    void drop() {
        stream_.socket().async_read_some(
            boost::asio::buffer(part_),
            [self = shared_from_this()](error_code error, std::size_t bytes) {
                self->context_.telemetry->metrics.bytes(observe::Peer::Http, observe::Direction::In,
                                                        bytes);
                self->droppedBytes_ += bytes;
                if (!error && self->droppedBytes_ < kMaxDroppedBytes)
                    self->drop();
            });
    }

    Crowd::Waiting waiting_;
    Stream stream_;
    boost::asio::steady_timer patience_;
    std::array<char, 16 * 1024> part_{};
    std::uint64_t droppedBytes_ = 0;
    Context& context_;
    Slot slot_;
};

}  // namespace

void closeOnceRead(Stream stream, const std::string& address, Context& context, Slot slot) {
    std::make_shared<LateClose>(std::move(stream), context, std::move(slot))->begin(address);
}

}  // namespace eyrie::http
