// SPDX-License-Identifier: Apache-2.0
#include "service/reply_stream.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "wire/frame.h"
#include "wire/statistics.h"
#include "wire/status.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

static_assert(std::endian::native == std::endian::little, "depth travels little-endian");

template <typename T>
std::span<const char> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

void ReplyStream::send(fabric::ChannelResult result) {
    result_ = std::move(result);
    const fabric::Image& image = result_.image;
    total_ = bytesOf(image.colour).size() + bytesOf(image.depth).size();
    v1::ChannelHeader& header = *message_.mutable_header();
    *header.mutable_area() = wire::toMessage(image.area);
    header.set_has_depth(image.hasDepth());
    header.set_pixel_bytes(total_);
    *header.mutable_statistics() = wire::toMessage(result_.statistics);
    if (total_ == 0)
        StartWriteAndFinish(&message_, {}, grpc::Status::OK);
    else
        StartWrite(&message_);
}

void ReplyStream::fail(const absl::Status& status) { Finish(wire::toGrpc(status)); }

void ReplyStream::OnWriteDone(bool ok) {
    if (!ok || isCancelled()) {
        // After the last write Finish has been called with it.
        if (sent_ < total_)
            Finish(grpc::Status::CANCELLED);
    } else if (sent_ < total_) {
        writeNext();
    }
}

std::span<const char> ReplyStream::nextChunk() const {
    const std::span<const char> colour = bytesOf(result_.image.colour);
    const bool inColour = sent_ < colour.size();
    const std::span<const char> rest =
        inColour ? colour.subspan(sent_)
                 : bytesOf(result_.image.depth).subspan(sent_ - colour.size());
    return rest.first(std::min(rest.size(), wire::kChunkBytes));
}

void ReplyStream::writeNext() {
    const std::span<const char> chunk = nextChunk();
    message_.mutable_chunk()->assign(chunk.data(), chunk.size());
    sent_ += chunk.size();
    if (sent_ == total_)
        StartWriteAndFinish(&message_, {}, grpc::Status::OK);
    else
        StartWrite(&message_);
}

void ReplyStream::OnDone() {
    onGone_();
    delete this;
}

}  // namespace eyrie::service
