// SPDX-License-Identifier: Apache-2.0
#include "video/libav/movie.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "video/libav/owners.h"
#include "video/libav/planes.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/opt.h>
}

namespace eyrie::video {
namespace {

struct Kind {
    std::string_view ending;
    const char* container;
    const char* encoder;
};
constexpr std::array<Kind, 3> kKinds = {
    {{"mp4", "mp4", "libx264"}, {"mkv", "matroska", "libx264"}, {"webm", "webm", "libvpx-vp9"}}};

constexpr int kBufferBytes = 64 * 1024;

struct FreeOutput {
    void operator()(AVFormatContext* output) const { avformat_free_context(output); }
};
using Output = std::unique_ptr<AVFormatContext, FreeOutput>;

absl::Status failed(const char* what, int code) {
    return absl::InternalError(fmt::format("video: {}: {}", what, errorText(code)));
}

/// A MovieSink as libavformat writes to files. Keeps the sink's first error.
class SinkIo {
public:
    explicit SinkIo(MovieSink sink) : sink_(std::move(sink)) {
        auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
        io_ = avio_alloc_context(buffer, kBufferBytes, 1, this, nullptr, write, seek);
    }
    ~SinkIo() {
        if (io_ != nullptr)
            av_freep(&io_->buffer);
        avio_context_free(&io_);
    }
    SinkIo(const SinkIo&) = delete;
    SinkIo& operator=(const SinkIo&) = delete;

    AVIOContext* io() const { return io_; }
    const absl::Status& status() const { return status_; }

private:
    static int write(void* self, std::uint8_t* bytes, int count) {
        auto& sink = *static_cast<SinkIo*>(self);
        if (sink.status_.ok())
            sink.status_ =
                sink.sink_(static_cast<std::uint64_t>(sink.at_),
                           std::as_bytes(std::span(bytes, static_cast<std::size_t>(count))));
        if (!sink.status_.ok())
            return AVERROR(EIO);
        sink.at_ += count;
        sink.size_ = std::max(sink.size_, sink.at_);
        return count;
    }

    static std::int64_t seek(void* self, std::int64_t offset, int whence) {
        auto& sink = *static_cast<SinkIo*>(self);
        switch (whence & ~AVSEEK_FORCE) {
            case AVSEEK_SIZE:
                return sink.size_;
            case SEEK_SET:
                return sink.at_ = offset;
            case SEEK_CUR:
                return sink.at_ += offset;
            case SEEK_END:
                return sink.at_ = sink.size_ + offset;
            default:
                return AVERROR(EINVAL);
        }
    }

    const MovieSink sink_;
    AVIOContext* io_ = nullptr;
    std::int64_t at_ = 0;
    std::int64_t size_ = 0;
    absl::Status status_ = absl::OkStatus();
};

class LibavMovie final : public Movie {
public:
    LibavMovie(const MovieSettings& settings, MovieSink sink)
        : settings_(settings), sink_(std::move(sink)) {}

    absl::Status open(const Kind& kind) {
        AVFormatContext* output = nullptr;
        if (sink_.io() == nullptr ||
            avformat_alloc_output_context2(&output, nullptr, kind.container, nullptr) < 0)
            return absl::ResourceExhaustedError("video: no memory for a file");
        output_.reset(output);
        output_->pb = sink_.io();
        RETURN_IF_ERROR(openEncoder(kind));
        track_ = avformat_new_stream(output, nullptr);
        packet_.reset(av_packet_alloc());
        if (track_ == nullptr || packet_ == nullptr)
            return absl::ResourceExhaustedError("video: no memory for a file");
        track_->time_base = context_->time_base;
        track_->avg_frame_rate = {settings_.framesPerSecond, 1};
        avcodec_parameters_from_context(track_->codecpar, context_.get());
        if (const int code = avformat_write_header(output, nullptr); code < 0)
            return told("its header", code);
        return absl::OkStatus();
    }

    absl::Status add(const fabric::Image& image) override {
        if (image.area.width != settings_.width || image.area.height != settings_.height)
            return absl::InvalidArgumentError(
                fmt::format("video: a picture of {}x{} in a movie of {}x{}", image.area.width,
                            image.area.height, settings_.width, settings_.height));
        if (av_frame_make_writable(frame_.get()) != 0)
            return absl::ResourceExhaustedError("video: no memory for a frame");
        fillPlanes(image, *frame_);
        frame_->pts = pictures_++;
        return encode(frame_.get());
    }

    absl::Status finish() override {
        RETURN_IF_ERROR(encode(nullptr));
        if (const int code = av_write_trailer(output_.get()); code < 0)
            return told("its end", code);
        avio_flush(sink_.io());
        return sink_.status();
    }

private:
    /// What the sink said, which is more than libavformat knows.
    absl::Status told(const char* what, int code) const {
        return sink_.status().ok() ? failed(what, code) : sink_.status();
    }

    absl::Status openEncoder(const Kind& kind) {
        const AVCodec* codec = avcodec_find_encoder_by_name(kind.encoder);
        if (codec == nullptr)
            return absl::FailedPreconditionError(fmt::format(
                "video: the libavcodec of this machine has no {}; Debian's has", kind.encoder));
        context_.reset(avcodec_alloc_context3(codec));
        if (context_ == nullptr)
            return absl::ResourceExhaustedError("video: no memory for an encoder");
        ASSIGN_OR_RETURN(frame_, makePlanes(settings_.width, settings_.height));
        context_->width = frame_->width;
        context_->height = frame_->height;
        context_->pix_fmt = AV_PIX_FMT_YUV420P;
        context_->color_range = frame_->color_range;
        context_->colorspace = frame_->colorspace;
        context_->color_primaries = frame_->color_primaries;
        context_->color_trc = frame_->color_trc;
        context_->time_base = {1, settings_.framesPerSecond};
        context_->framerate = {settings_.framesPerSecond, 1};
        context_->gop_size = 2 * settings_.framesPerSecond;  // to jump to any second or so
        if ((output_->oformat->flags & AVFMT_GLOBALHEADER) != 0)
            context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        // About 45 dB on terrain: nothing to be seen beside the pictures themselves.
        if (kind.ending == "webm") {
            av_opt_set(context_->priv_data, "crf", "18", 0);
            av_opt_set(context_->priv_data, "deadline", "good", 0);
            av_opt_set(context_->priv_data, "cpu-used", "4", 0);
            av_opt_set(context_->priv_data, "row-mt", "1", 0);
        } else {
            av_opt_set(context_->priv_data, "crf", "16", 0);
            av_opt_set(context_->priv_data, "preset", "medium", 0);
        }
        if (const int code = avcodec_open2(context_.get(), codec, nullptr); code != 0)
            return failed(kind.encoder, code);
        return absl::OkStatus();
    }

    /// Null: no more come.
    absl::Status encode(const AVFrame* frame) {
        if (const int code = avcodec_send_frame(context_.get(), frame); code != 0)
            return failed("encoding", code);
        for (;;) {
            const int code = avcodec_receive_packet(context_.get(), packet_.get());
            if (code == AVERROR(EAGAIN) || code == AVERROR_EOF)
                return sink_.status();
            if (code != 0)
                return failed("encoding", code);
            packet_->duration = 1;
            packet_->stream_index = track_->index;
            av_packet_rescale_ts(packet_.get(), context_->time_base, track_->time_base);
            if (const int wrote = av_interleaved_write_frame(output_.get(), packet_.get());
                wrote < 0)
                return told("writing", wrote);
        }
    }

    const MovieSettings settings_;
    SinkIo sink_;
    Output output_;
    Context context_;
    Frame frame_;
    Packet packet_;
    AVStream* track_ = nullptr;  ///< of output_
    std::int64_t pictures_ = 0;
};

absl::Status check(const MovieSettings& settings) {
    if (settings.width < 16 || settings.height < 16 || settings.width % 2 != 0 ||
        settings.height % 2 != 0 || std::int64_t{settings.width} * settings.height > kMostPixels)
        return absl::InvalidArgumentError(
            fmt::format("a video's sides are even, 16 and more, and its pixels at most {}; these "
                        "are {}x{}",
                        kMostPixels, settings.width, settings.height));
    if (settings.framesPerSecond < 1 || settings.framesPerSecond > 240)
        return absl::InvalidArgumentError(
            fmt::format("a video has 1 to 240 frames a second, not {}", settings.framesPerSecond));
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Movie>> makeMovie(const MovieSettings& settings, MovieSink sink) {
    RETURN_IF_ERROR(check(settings));
    for (const Kind& kind : kKinds) {
        if (kind.ending != settings.ending)
            continue;
        auto movie = std::make_unique<LibavMovie>(settings, std::move(sink));
        RETURN_IF_ERROR(movie->open(kind));
        return movie;
    }
    return absl::InvalidArgumentError(
        fmt::format("a video ends in .mp4, .mkv or .webm, not in .{}", settings.ending));
}

}  // namespace eyrie::video
