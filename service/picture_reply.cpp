// SPDX-License-Identifier: Apache-2.0
#include "service/picture_reply.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "wire/jpeg.h"
#include "wire/picture_header.h"
#include "wire/statistics.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

std::int64_t nanoseconds(ChannelStory::Clock::time_point time) {
    return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

v1::RendererMemory messageOf(const DrawerMemory& memory) {
    v1::RendererMemory message;
    message.set_device_bytes(memory.deviceBytes);
    message.set_host_bytes(memory.hostBytes);
    return message;
}

void tell(const ChannelStory& story, v1::ChannelHeader& header) {
    v1::ChannelTimes& times = *header.mutable_times();
    times.set_received(nanoseconds(story.received));
    times.set_begun(nanoseconds(story.begun));
    times.set_drawn(nanoseconds(story.drawn));
    times.set_sent(nanoseconds(ChannelStory::Clock::now()));
    *header.mutable_memory() = messageOf(story.memory);
}

class MemoryReply final : public MessageSource<v1::RenderChannelResponse> {
public:
    MemoryReply(const fabric::ChannelResult& result, bool hasDepth, const ChannelStory& story)
        : area_(result.image.area),
          hasDepth_(hasDepth),
          statistics_(result.statistics),
          story_(story) {}

    bool isDone() const override { return isDone_; }

    void next(v1::RenderChannelResponse& message) override {
        v1::ChannelHeader& header = *message.mutable_header();
        wire::describe(area_, hasDepth_, wire::PixelEncoding::Raw, header);
        header.set_is_in_memory(true);
        *header.mutable_statistics() = wire::toMessage(statistics_);
        tell(story_, header);
        isDone_ = true;
    }

private:
    const fabric::PixelViewport area_;
    const bool hasDepth_;
    const fabric::FrameStatistics statistics_;
    const ChannelStory story_;
    bool isDone_ = false;
};

class ChannelReply final : public MessageSource<v1::RenderChannelResponse> {
public:
    ChannelReply(fabric::ChannelResult result, wire::PixelEncoding encoding,
                 const ChannelStory& story)
        : result_(std::move(result)),
          encoding_(encoding),
          story_(story),
          pixels_(result_.image, encoding_) {}

    bool isDone() const override { return hasHeader_ && pixels_.isDone(); }

    void next(v1::RenderChannelResponse& message) override {
        if (std::exchange(hasHeader_, true))
            return pixels_.next(*message.mutable_chunk());
        wire::describe(result_.image, encoding_, *message.mutable_header());
        *message.mutable_header()->mutable_statistics() = wire::toMessage(result_.statistics);
        tell(story_, *message.mutable_header());
    }

private:
    const fabric::ChannelResult result_;
    const wire::PixelEncoding encoding_;
    const ChannelStory story_;
    wire::PictureWriter pixels_;
    bool hasHeader_ = false;
};

class JpegReply final : public MessageSource<v1::RenderChannelResponse> {
public:
    JpegReply(fabric::ChannelResult result, const fabric::ChannelTask& task,
              fabric::Rgba background, const ChannelStory& story)
        : result_(std::move(result)),
          whole_(task.pixelViewport),
          quality_(task.jpegQuality),
          background_(background),
          story_(story) {}

    bool isDone() const override { return encoded_ && sent_ == encoded_->size(); }

    void next(v1::RenderChannelResponse& message) override {
        if (!std::exchange(hasHeader_, true))
            return begin(*message.mutable_header());
        if (!encoded_)
            encoded_ = encode();
        const std::size_t size = std::min(encoded_->size() - sent_, wire::kChunkBytes);
        message.mutable_chunk()->assign(reinterpret_cast<const char*>(encoded_->data()) + sent_,
                                        size);
        sent_ += size;
    }

private:
    void begin(v1::ChannelHeader& header) const {
        wire::describe(result_.image, wire::PixelEncoding::Raw, header);
        header.set_is_jpeg(true);
        *header.mutable_statistics() = wire::toMessage(result_.statistics);
        tell(story_, header);
    }

    /// Empty on an error, of which there is none but for want of memory: who reads it says that
    /// the JPEG is missing.
    std::vector<std::byte> encode() const {
        const bool isWhole = result_.image.area == whole_;
        fabric::Image filled;
        if (!isWhole) {
            filled = fabric::makeImage(whole_, background_, false);
            fabric::paste(result_.image, filled);
        }
        return wire::encodeJpeg(isWhole ? result_.image : filled, quality_,
                                wire::ChromaSubsampling::Half)
            .value_or(std::vector<std::byte>());
    }

    const fabric::ChannelResult result_;
    const fabric::PixelViewport whole_;
    const int quality_;
    const fabric::Rgba background_;
    const ChannelStory story_;
    bool hasHeader_ = false;
    std::optional<std::vector<std::byte>> encoded_;
    std::size_t sent_ = 0;
};

class ProgramReply final : public MessageSource<v1::RunProgramResponse> {
public:
    ProgramReply(ProgramAnswer answer, wire::PixelEncoding encoding)
        : result_(std::move(answer.result)), memory_(answer.memory), encoding_(encoding) {}

    bool isDone() const override { return isDone_; }

    void next(v1::RunProgramResponse& message) override {
        if (pixels_ && !pixels_->isDone())
            return pixels_->next(*message.mutable_chunk());
        pixels_.reset();
        if (picture_ < result_.pictures.size())
            return begin(result_.pictures[picture_++], *message.mutable_header());
        for (const fabric::FrameStatistics& draw : result_.draws)
            *message.mutable_statistics()->add_draws() = wire::toMessage(draw);
        if (memory_)
            *message.mutable_statistics()->mutable_memory() = messageOf(*memory_);
        message.mutable_statistics();  // the end, even where nothing was drawn
        isDone_ = true;
    }

private:
    void begin(const fabric::ProgramPicture& picture, v1::ProgramPictureHeader& header) {
        header.set_frame(picture.frame);
        wire::describe(picture.image, encoding_, header);
        pixels_.emplace(picture.image, encoding_);
    }

    const fabric::ProgramResult result_;
    const std::optional<DrawerMemory> memory_;
    const wire::PixelEncoding encoding_;
    std::size_t picture_ = 0;  ///< the next one
    std::optional<wire::PictureWriter> pixels_;
    bool isDone_ = false;
};

}  // namespace

std::unique_ptr<MessageSource<v1::RenderChannelResponse>> replyInMemory(
    const fabric::ChannelResult& result, bool hasDepth, const ChannelStory& story) {
    return std::make_unique<MemoryReply>(result, hasDepth, story);
}

std::unique_ptr<MessageSource<v1::RenderChannelResponse>> channelReply(fabric::ChannelResult result,
                                                                       wire::PixelEncoding encoding,
                                                                       const ChannelStory& story) {
    return std::make_unique<ChannelReply>(std::move(result), encoding, story);
}

std::unique_ptr<MessageSource<v1::RenderChannelResponse>> jpegReply(fabric::ChannelResult result,
                                                                    const fabric::ChannelTask& task,
                                                                    fabric::Rgba background,
                                                                    const ChannelStory& story) {
    return std::make_unique<JpegReply>(std::move(result), task, background, story);
}

std::unique_ptr<MessageSource<v1::RunProgramResponse>> programReply(ProgramAnswer answer,
                                                                    wire::PixelEncoding encoding) {
    return std::make_unique<ProgramReply>(std::move(answer), encoding);
}

}  // namespace eyrie::service
