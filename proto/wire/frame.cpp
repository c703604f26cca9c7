// SPDX-License-Identifier: Apache-2.0
#include "wire/frame.h"

#include <fmt/format.h>

#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/look.pb.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/look.h"
#include "wire/shading.h"
#include "wire/sight.h"

namespace eyrie::wire {
namespace {

v1::Occlusion toMessage(fabric::Occlusion occlusion) {
    switch (occlusion) {
        case fabric::Occlusion::Auto:
            return v1::OCCLUSION_AUTO;
        case fabric::Occlusion::On:
            return v1::OCCLUSION_ON;
        case fabric::Occlusion::Off:
            return v1::OCCLUSION_OFF;
    }
    return v1::OCCLUSION_UNSPECIFIED;
}

absl::StatusOr<fabric::Occlusion> fromMessage(v1::Occlusion occlusion) {
    switch (occlusion) {
        case v1::OCCLUSION_UNSPECIFIED:
        case v1::OCCLUSION_AUTO:
            return fabric::Occlusion::Auto;
        case v1::OCCLUSION_ON:
            return fabric::Occlusion::On;
        case v1::OCCLUSION_OFF:
            return fabric::Occlusion::Off;
        default:
            return absl::InvalidArgumentError(
                fmt::format("frame_data.occlusion is {}, which this version does not know",
                            static_cast<int>(occlusion)));
    }
}

v1::Completeness toMessage(fabric::Completeness completeness) {
    return completeness == fabric::Completeness::Interactive ? v1::COMPLETENESS_INTERACTIVE
                                                             : v1::COMPLETENESS_COMPLETE;
}

absl::StatusOr<fabric::Completeness> fromMessage(v1::Completeness completeness) {
    switch (completeness) {
        case v1::COMPLETENESS_UNSPECIFIED:
        case v1::COMPLETENESS_COMPLETE:
            return fabric::Completeness::Complete;
        case v1::COMPLETENESS_INTERACTIVE:
            return fabric::Completeness::Interactive;
        default:
            return absl::InvalidArgumentError(
                fmt::format("task.completeness is {}, which this version does not know",
                            static_cast<int>(completeness)));
    }
}

absl::Status checkPixels(std::int32_t value, std::int32_t least, std::string_view field) {
    if (value >= least && value <= fabric::kMaxViewPixels)
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format("{} is {}; it must be from {} to {} pixels",
                                                  field, value, least, fabric::kMaxViewPixels));
}

v1::Raster toMessage(const fabric::Raster& raster) {
    v1::Raster message;
    message.set_width(raster.width);
    message.set_height(raster.height);
    message.set_origin_x(raster.origin.x);
    message.set_origin_y(raster.origin.y);
    message.set_step_x(raster.step.x);
    message.set_step_y(raster.step.y);
    return message;
}

fabric::Raster fromMessage(const v1::Raster& message) {
    return {message.width(),
            message.height(),
            {message.origin_x(), message.origin_y()},
            {message.step_x(), message.step_y()}};
}

}  // namespace

v1::FrameData toMessage(const fabric::FrameData& frameData) {
    v1::FrameData message;
    message.set_version(frameData.version);
    *message.mutable_camera() = toMessage(frameData.camera);
    message.set_tau_pixels(frameData.tauPixels);
    message.set_shading(toMessage(frameData.shading));
    *message.mutable_look() = toMessage(frameData.look);
    message.set_occlusion(toMessage(frameData.occlusion));
    if (frameData.budget) {
        v1::FrameBudget& budget = *message.mutable_budget();
        budget.set_milliseconds(frameData.budget->milliseconds);
        budget.set_fixed_milliseconds(frameData.budget->fixedMilliseconds);
        budget.set_milliseconds_a_triangle(frameData.budget->millisecondsATriangle);
        budget.set_last_tau_pixels(frameData.budget->lastTauPixels);
    }
    return message;
}

absl::StatusOr<fabric::FrameData> fromMessage(const v1::FrameData& message) {
    fabric::FrameData frameData;
    frameData.version = message.version();
    if (frameData.version == 0)
        return absl::InvalidArgumentError("frame_data.version is 0; versions start at 1");
    ASSIGN_OR_RETURN(frameData.camera, fromMessage(message.camera()));
    frameData.tauPixels = message.tau_pixels();
    if (!(frameData.tauPixels >= fabric::kMinTauPixels &&
          frameData.tauPixels <= fabric::kMaxTauPixels))
        return absl::InvalidArgumentError(
            fmt::format("frame_data.tau_pixels is {}; it must be from {} to {}",
                        frameData.tauPixels, fabric::kMinTauPixels, fabric::kMaxTauPixels));
    ASSIGN_OR_RETURN(frameData.shading, shadingFrom(message.shading(), "frame_data.shading"));
    ASSIGN_OR_RETURN(frameData.look, fromMessage(message.look()));
    ASSIGN_OR_RETURN(frameData.occlusion, fromMessage(message.occlusion()));
    if (message.has_budget()) {
        const v1::FrameBudget& budget = message.budget();
        frameData.budget = {budget.milliseconds(), budget.fixed_milliseconds(),
                            budget.milliseconds_a_triangle(), budget.last_tau_pixels()};
        RETURN_IF_ERROR(fabric::withContext(fabric::validate(*frameData.budget), "frame_data"));
    }
    return frameData;
}

v1::PixelViewport toMessage(const fabric::PixelViewport& viewport) {
    v1::PixelViewport message;
    message.set_x(viewport.x);
    message.set_y(viewport.y);
    message.set_width(viewport.width);
    message.set_height(viewport.height);
    return message;
}

absl::StatusOr<fabric::PixelViewport> fromMessage(const v1::PixelViewport& message) {
    RETURN_IF_ERROR(checkPixels(message.x(), 0, "pixel_viewport.x"));
    RETURN_IF_ERROR(checkPixels(message.y(), 0, "pixel_viewport.y"));
    RETURN_IF_ERROR(checkPixels(message.width(), 0, "pixel_viewport.width"));
    RETURN_IF_ERROR(checkPixels(message.height(), 0, "pixel_viewport.height"));
    return fabric::PixelViewport{message.x(), message.y(), message.width(), message.height()};
}

v1::Range toMessage(const fabric::Range& range) {
    v1::Range message;
    message.set_begin(range.begin);
    message.set_end(range.end);
    return message;
}

absl::StatusOr<fabric::Range> fromMessage(const v1::Range& message) {
    const fabric::Range range{message.begin(), message.end()};
    if (!(range.begin >= 0 && range.begin <= range.end && range.end <= 1))
        return absl::InvalidArgumentError(fmt::format(
            "range is {} to {}; it must be 0 <= begin <= end <= 1", range.begin, range.end));
    return range;
}

v1::ChannelTask toMessage(const fabric::ChannelTask& task) {
    v1::ChannelTask message;
    message.set_frame_number(task.frameNumber);
    message.set_frame_data_version(task.frameDataVersion);
    message.set_view_width(task.viewWidth);
    message.set_view_height(task.viewHeight);
    *message.mutable_pixel_viewport() = toMessage(task.pixelViewport);
    *message.mutable_range() = toMessage(task.range);
    message.set_wants_depth(task.wantsDepth);
    message.set_completeness(toMessage(task.completeness));
    message.set_measures_stages(task.measuresStages);
    if (task.sight)
        *message.mutable_sight() = toMessage(*task.sight);
    if (task.raster)
        *message.mutable_raster() = toMessage(*task.raster);
    message.set_jpeg_quality(task.jpegQuality);
    return message;
}

absl::StatusOr<fabric::ChannelTask> fromMessage(const v1::ChannelTask& message) {
    fabric::ChannelTask task;
    task.frameNumber = message.frame_number();
    task.frameDataVersion = message.frame_data_version();
    task.viewWidth = message.view_width();
    task.viewHeight = message.view_height();
    RETURN_IF_ERROR(checkPixels(task.viewWidth, 1, "task.view_width"));
    RETURN_IF_ERROR(checkPixels(task.viewHeight, 1, "task.view_height"));
    ASSIGN_OR_RETURN(task.pixelViewport, fromMessage(message.pixel_viewport()));
    if (message.has_sight()) {
        ASSIGN_OR_RETURN(task.sight, fromMessage(message.sight()));
    }
    if (message.has_raster()) {
        task.raster = fromMessage(message.raster());
        RETURN_IF_ERROR(fabric::validate(*task.raster, task.viewWidth, task.viewHeight));
    }
    const fabric::PixelViewport& part = task.pixelViewport;
    const fabric::PixelViewport picture = fabric::pictureOf(task);
    if (part.isEmpty() || !picture.contains(part))
        return absl::InvalidArgumentError(fmt::format(
            "task.pixel_viewport is {}x{} pixels at {},{}; it must not be empty and lie inside the "
            "{} of {}x{}",
            part.width, part.height, part.x, part.y, task.raster ? "raster" : "view", picture.width,
            picture.height));
    if (message.has_range()) {
        ASSIGN_OR_RETURN(task.range, fromMessage(message.range()));
    }
    task.wantsDepth = message.wants_depth();
    ASSIGN_OR_RETURN(task.completeness, fromMessage(message.completeness()));
    task.measuresStages = message.measures_stages();
    task.jpegQuality = message.jpeg_quality();
    if (task.jpegQuality < 0 || task.jpegQuality > 100)
        return absl::InvalidArgumentError(
            fmt::format("task.jpeg_quality is {}; it must be 0 to 100", task.jpegQuality));
    if (task.jpegQuality > 0 && task.wantsDepth)
        return absl::InvalidArgumentError(
            "task.jpeg_quality and task.wants_depth are both set; a JPEG has no depth");
    return task;
}

}  // namespace eyrie::wire
