// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/answer_shares.h"
#include "coordinator/api/asked_view.h"
#include "coordinator/api/field_names.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/stream/statistics_feed.h"
#include "coordinator/stream/statistics_message.h"
#include "coordinator/stream/view_message.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/depth_metres.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/frame.h"
#include "wire/jpeg.h"
#include "wire/look.h"
#include "wire/png.h"

namespace eyrie::api {
namespace {

constexpr int kMaxSide = 8192;
constexpr int kUsualQuality = 90;

/// Of an answer, in pixels.
struct AnswerSize {
    std::int64_t width = 0;
    std::int64_t height = 0;

    std::int64_t area() const { return width * height; }
    bool hasPixels() const { return width > 0 && height > 0; }
};

/// The sides that are asked for are those of one eye's picture.
AnswerSize answerSize(const coordinator::FrameRequest& request) {
    const fabric::PixelViewport drawn = request.drawnPart();
    const coordinator::Shown& shown = request.shown.front();
    return {std::int64_t{drawn.width} * shown.eyesAcross(),
            std::int64_t{drawn.height} * shown.eyesUp()};
}

/// Of a whole answer.
absl::Status checkSize(const AnswerSize& size, std::int64_t mostPixels) {
    if (size.width < 1 || size.width > kMaxSide)
        return absl::InvalidArgumentError(
            fmt::format("width makes {} pixels; it must be from 1 to {}", size.width, kMaxSide));
    if (size.height < 1 || size.height > kMaxSide)
        return absl::InvalidArgumentError(
            fmt::format("height makes {} pixels; it must be from 1 to {}", size.height, kMaxSide));
    if (size.area() > mostPixels)
        return absl::InvalidArgumentError(
            fmt::format("height makes {}x{} pixels, {} in all; at most {} are drawn at once, and "
                        "more part by part or by `eyrie render`",
                        size.width, size.height, size.area(), mostPixels));
    return absl::OkStatus();
}

/// Of a picture that is asked for part by part.
absl::Status checkPart(const coordinator::FrameRequest& request) {
    const fabric::PixelViewport& part = request.part;
    for (const int side : {request.width, request.height})
        if (side < 1 || side > fabric::kMaxViewPixels)
            return absl::InvalidArgumentError(
                fmt::format("part is of a picture of {}x{} pixels; each side must be from 1 to {}",
                            request.width, request.height, fabric::kMaxViewPixels));
    if (part.isEmpty() ||
        !fabric::PixelViewport{0, 0, request.width, request.height}.contains(part))
        return absl::InvalidArgumentError(
            fmt::format("part is {}x{}+{}+{}; it must lie in the picture of {}x{} pixels",
                        part.width, part.height, part.x, part.y, request.width, request.height));
    return absl::OkStatus();
}

/// Of an answer as JSON.
absl::Status checkTextSize(const coordinator::FrameRequest& request) {
    const AnswerSize size = answerSize(request);
    if (size.area() <= Quotas::kMostTextPixels)
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format(
        "{} makes {}x{} pixels, {} in all, of which JSON has at most {}; ask for the picture's own "
        "bytes, for depths by IMAGE_FORMAT_DEPTH, or part by part",
        request.part.isEmpty() ? "height" : "part", size.width, size.height, size.area(),
        Quotas::kMostTextPixels));
}

absl::Status checkFormat(const v1::RenderImageRequest& request) {
    if (!v1::ImageFormat_IsValid(request.format()))
        return absl::InvalidArgumentError(
            fmt::format("format is {}; it must be one that this version knows",
                        static_cast<int>(request.format())));
    if (request.has_jpeg_quality() && (request.jpeg_quality() < 1 || request.jpeg_quality() > 100))
        return absl::InvalidArgumentError(
            fmt::format("jpeg_quality is {}; it must be from 1 to 100", request.jpeg_quality()));
    return absl::OkStatus();
}

absl::StatusOr<coordinator::FrameRequest> requestOf(const v1::RenderImageRequest& message,
                                                    const coordinator::FrameSource& frames,
                                                    const QuotaKeeper& quotas, bool asText) {
    RETURN_IF_ERROR(checkFormat(message));
    const std::int64_t mostPixels = quotas.most().imagePixels;
    coordinator::FrameRequest request;
    ASSIGN_OR_RETURN(coordinator::Shown shown, stream::shownFromMessage(message.shown()));
    request.shown = {std::move(shown)};
    request.width = message.has_width() ? message.width() : kUsualWidth;
    request.height = message.has_height() ? message.height() : kUsualHeight;
    if (message.has_part()) {
        request.part = {message.part().x(), message.part().y(), message.part().width(),
                        message.part().height()};
        RETURN_IF_ERROR(checkPart(request));
    }
    const AnswerSize size = answerSize(request);
    absl::Status fits = checkSize(size, mostPixels);
    if (size.hasPixels())  // to ask for none is a mistake, and none of a quota
        fits = quotas.counted(observe::Quota::Image, fits);
    RETURN_IF_ERROR(message.has_part() ? fabric::withContext(fits, "part") : fits);
    if (asText)
        RETURN_IF_ERROR(quotas.counted(observe::Quota::Image, checkTextSize(request)));
    ASSIGN_OR_RETURN(request.look, wire::fromMessage(message.look()));
    ASSIGN_OR_RETURN(request.camera, cameraOf(message.camera(), frames, request.look.exaggeration));
    v1::FrameData data;
    data.set_version(1);
    *data.mutable_camera() = wire::toMessage(request.camera);
    data.set_tau_pixels(message.has_tau_pixels() ? message.tau_pixels() : request.tauPixels);
    data.set_shading(message.shading());
    const absl::StatusOr<fabric::FrameData> frameData = wire::fromMessage(data);
    RETURN_IF_ERROR(inRequest(frameData.status(), "", *v1::RenderImageRequest::descriptor()));
    request.tauPixels = frameData->tauPixels;
    request.shading = frameData->shading;
    request.wantsDepth = message.with_depth() || message.format() == v1::IMAGE_FORMAT_DEPTH;
    return request;
}

/// The bytes of pixels, rows from the top down. Nothing is filled before it is written: these are
/// megabytes.
template <typename Pixel>
std::string upright(const std::vector<Pixel>& pixels, const fabric::PixelViewport& area) {
    static_assert(std::endian::native == std::endian::little);
    const auto width = static_cast<std::size_t>(area.width);
    std::string bytes;
    bytes.reserve(pixels.size() * sizeof(Pixel));
    for (auto row = static_cast<std::size_t>(area.height); row-- > 0;)
        bytes.append(reinterpret_cast<const char*>(&pixels[row * width]), width * sizeof(Pixel));
    return bytes;
}

/// Anaglyphs have no depths, whether the request or the configuration makes them.
absl::Status checkDepth(const fabric::Image& image, const v1::RenderImageRequest& request) {
    const bool isMap = request.format() == v1::IMAGE_FORMAT_DEPTH;
    if (image.hasDepth() || (!isMap && !request.with_depth()))
        return absl::OkStatus();
    return absl::FailedPreconditionError(fmt::format(
        "{}, and what is shown has no depths, as an anaglyph has none; ask for colours or for one "
        "eye",
        isMap ? "format is IMAGE_FORMAT_DEPTH" : "with_depth is set"));
}

std::string floatMap(const fabric::Image& image) {
    std::string map = fabric::floatMapHead(image.area.width, image.area.height);
    const std::vector<float> metres = fabric::depthMetres(image);
    map.append(reinterpret_cast<const char*>(metres.data()), metres.size() * sizeof(float));
    return map;
}

absl::StatusOr<std::string> encoded(const fabric::Image& image,
                                    const v1::RenderImageRequest& request) {
    if (request.format() == v1::IMAGE_FORMAT_RAW)
        return upright(image.colour, image.area);
    if (request.format() == v1::IMAGE_FORMAT_DEPTH)
        return floatMap(image);
    const int quality = request.has_jpeg_quality() ? request.jpeg_quality() : kUsualQuality;
    auto bytes = request.format() == v1::IMAGE_FORMAT_JPEG
                     ? wire::encodeJpeg(image, quality, wire::ChromaSubsampling::None)
                     : wire::encodePng(image);
    RETURN_IF_ERROR(bytes.status());
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

/// Who draws pictures for programs.
class Painter {
public:
    Painter(coordinator::FrameSource& frames, stream::StatisticsFeed& statistics,
            const QuotaKeeper& quotas)
        : frames_(frames),
          statistics_(statistics),
          quotas_(quotas),
          pixels_(std::min(2 * quotas.most().imagePixels, Quotas::kMostImagePixels)) {}

    absl::StatusOr<v1::RenderImageResponse> render(const v1::RenderImageRequest& request,
                                                   const Call& call);

private:
    absl::Status checkSeen(const coordinator::RenderedFrame& frame,
                           const coordinator::FrameRequest& asked) const;

    coordinator::FrameSource& frames_;
    stream::StatisticsFeed& statistics_;
    const QuotaKeeper& quotas_;
    const AnswerShares pixels_;  ///< each takes up to some 25 bytes
};

absl::StatusOr<v1::RenderImageResponse> Painter::render(const v1::RenderImageRequest& request,
                                                        const Call& call) {
    ASSIGN_OR_RETURN(coordinator::FrameRequest asked,
                     requestOf(request, frames_, quotas_, call.asText));
    asked.stop = call.stop;
    const std::shared_ptr<void> share = pixels_.take(call.taking(answerSize(asked).area()));
    if (share == nullptr)
        return quotas_.counted(
            observe::Quota::Image,
            absl::ResourceExhaustedError(
                "too many large pictures are being drawn or sent; try again in a bit"));
    call.keep(share);
    ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, frames_.renderFrame(asked));
    if (call.stop.stop_requested())
        return absl::CancelledError("the caller has gone");
    statistics_.drawn("", frame);
    RETURN_IF_ERROR(checkSeen(frame, asked));
    RETURN_IF_ERROR(checkDepth(frame.image, request));
    v1::RenderImageResponse response;
    ASSIGN_OR_RETURN(*response.mutable_image(), encoded(frame.image, request));
    response.set_format(request.format() == v1::IMAGE_FORMAT_UNSPECIFIED ? v1::IMAGE_FORMAT_PNG
                                                                         : request.format());
    response.set_width(frame.image.area.width);
    response.set_height(frame.image.area.height);
    if (request.with_depth())
        *response.mutable_depth() = upright(fabric::depthMetres(frame.image), frame.image.area);
    *response.mutable_statistics() =
        stream::statisticsMessage(frame, frame.image.area.width, frame.image.area.height);
    response.set_revision(frame.revision);
    return response;
}

/// A part that lies beside all that the whole picture shows is background, as it is there. So it is
/// where nobody could say by which sights that is seen: a canvas may be put together of others'
/// frames while its own wall shows the eye its back.
absl::Status Painter::checkSeen(const coordinator::RenderedFrame& frame,
                                const coordinator::FrameRequest& asked) const {
    const std::string why = coordinator::whyEmpty(frame);
    if (why.empty())
        return absl::OkStatus();
    if (!asked.part.isEmpty()) {
        coordinator::FrameRequest whole = asked;
        whole.part = {};
        const absl::StatusOr<fabric::SeenAreas> seen = frames_.seen(whole);
        if (!seen.ok() || !seen->has_value() || !(*seen)->empty())
            return absl::OkStatus();
    }
    return absl::FailedPreconditionError(why);
}

}  // namespace

void addImageHandlers(Handlers& handlers, coordinator::FrameSource& frames,
                      stream::StatisticsFeed& statistics, const QuotaKeeper& quotas) {
    handlers.add<v1::RenderImageRequest, v1::RenderImageResponse>(
        "RenderImage", [painter = std::make_shared<Painter>(frames, statistics, quotas)](
                           const v1::RenderImageRequest& request, const Call& call) {
            return painter->render(request, call);
        });
}

}  // namespace eyrie::api
