// SPDX-License-Identifier: Apache-2.0
#include "video/libav/stream.h"

#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "video/libav/owners.h"
#include "video/libav/planes.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace eyrie::video {
namespace {

constexpr int kLeastSide = 16;
/// Times are of the order of pictures only: how fast they come is the viewer's affair.
constexpr AVRational kPictureTime{1, 30};

absl::Status check(const StreamSettings& settings) {
    if (settings.width < kLeastSide || settings.height < kLeastSide ||
        std::int64_t{settings.width} * settings.height > kMostPixels)
        return absl::InvalidArgumentError(
            fmt::format("video: pictures of {}x{}; sides are {} and more, and pixels at most {}",
                        settings.width, settings.height, kLeastSide, kMostPixels));
    return absl::OkStatus();
}

class X264Stream final : public StreamEncoder {
public:
    X264Stream(Context context, Frame frame, Packet packet, const StreamSettings& settings)
        : context_(std::move(context)),
          frame_(std::move(frame)),
          packet_(std::move(packet)),
          settings_(settings) {}

    absl::StatusOr<StreamPicture> encode(const fabric::Image& image, bool asKey) override {
        if (image.area.width != settings_.width || image.area.height != settings_.height)
            return absl::InvalidArgumentError(
                fmt::format("video: a picture of {}x{} in a stream of {}x{}", image.area.width,
                            image.area.height, settings_.width, settings_.height));
        if (av_frame_make_writable(frame_.get()) != 0)
            return absl::ResourceExhaustedError("video: no memory for a frame");
        fillPlanes(image, *frame_);
        frame_->pts = pictures_++;
        frame_->pict_type = asKey ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
        if (const int code = avcodec_send_frame(context_.get(), frame_.get()); code != 0)
            return absl::InternalError(fmt::format("video: {}", errorText(code)));
        if (const int code = avcodec_receive_packet(context_.get(), packet_.get()); code != 0)
            return absl::InternalError(fmt::format("video: {}", errorText(code)));
        const auto* begin = reinterpret_cast<const std::byte*>(packet_->data);
        StreamPicture picture;
        picture.bytes.assign(begin, begin + packet_->size);
        picture.isKey = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
        av_packet_unref(packet_.get());
        return picture;
    }

private:
    const Context context_;
    const Frame frame_;
    const Packet packet_;
    const StreamSettings settings_;
    std::int64_t pictures_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<StreamEncoder>> makeStream(const StreamSettings& settings) {
    RETURN_IF_ERROR(check(settings));
    const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
    if (codec == nullptr)
        return absl::FailedPreconditionError(
            "video: the libavcodec of this machine has no libx264; Debian's has");
    Context context(avcodec_alloc_context3(codec));
    Packet packet(av_packet_alloc());
    if (context == nullptr || packet == nullptr)
        return absl::ResourceExhaustedError("video: no memory for an encoder");
    ASSIGN_OR_RETURN(Frame frame, makePlanes(settings.width, settings.height));
    context->width = frame->width;
    context->height = frame->height;
    context->pix_fmt = AV_PIX_FMT_YUV420P;
    context->color_range = frame->color_range;
    context->colorspace = frame->colorspace;
    context->color_primaries = frame->color_primaries;
    context->color_trc = frame->color_trc;
    context->time_base = kPictureTime;
    // Keys are made when a viewer needs one, and not at all otherwise.
    context->gop_size = 1 << 30;
    context->max_b_frames = 0;
    context->thread_count = 1;
    const std::string options = fmt::format("crf={}", settings.rateFactor);
    av_opt_set(context->priv_data, "preset", "superfast", 0);
    av_opt_set(context->priv_data, "tune", "zerolatency", 0);
    av_opt_set(context->priv_data, "forced-idr", "1", 0);
    av_opt_set(context->priv_data, "x264-params", (options + ":scenecut=0:keyint=infinite").c_str(),
               0);
    if (const int code = avcodec_open2(context.get(), codec, nullptr); code != 0)
        return absl::InternalError(fmt::format("video: libx264: {}", errorText(code)));
    return std::make_unique<X264Stream>(std::move(context), std::move(frame), std::move(packet),
                                        settings);
}

}  // namespace eyrie::video
