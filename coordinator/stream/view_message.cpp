// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/view_message.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "fabric/status.h"
#include "wire/frame.h"

namespace eyrie::stream {

absl::StatusOr<coordinator::Shown> shownFromMessage(const v1::ShownPicture& message) {
    using compound::Eye;
    using compound::Stereo;
    const auto unknown = [](const char* field, int value) {
        return absl::InvalidArgumentError(
            fmt::format("shown.{} is {}, which this version does not know", field, value));
    };
    if (!v1::ShownEye_IsValid(message.eye()))
        return unknown("eye", message.eye());
    if (!v1::ShownStereo_IsValid(message.stereo()))
        return unknown("stereo", message.stereo());
    coordinator::Shown shown;
    shown.canvas = message.canvas();
    shown.segment = message.segment();
    if (message.eye() == v1::SHOWN_EYE_CYCLOP)
        shown.eye = Eye::Cyclop;
    else if (message.eye() == v1::SHOWN_EYE_LEFT)
        shown.eye = Eye::Left;
    else if (message.eye() == v1::SHOWN_EYE_RIGHT)
        shown.eye = Eye::Right;
    if (message.stereo() == v1::SHOWN_STEREO_ANAGLYPH)
        shown.stereo = Stereo::Anaglyph;
    else if (message.stereo() == v1::SHOWN_STEREO_SIDE_BY_SIDE)
        shown.stereo = Stereo::SideBySide;
    else if (message.stereo() == v1::SHOWN_STEREO_TOP_BOTTOM)
        shown.stereo = Stereo::TopBottom;
    return shown;
}

namespace {

v1::ShownEye toMessage(compound::Eye eye) {
    using compound::Eye;
    return eye == Eye::Left    ? v1::SHOWN_EYE_LEFT
           : eye == Eye::Right ? v1::SHOWN_EYE_RIGHT
                               : v1::SHOWN_EYE_CYCLOP;
}

v1::ShownStereo toMessage(compound::Stereo stereo) {
    using compound::Stereo;
    return stereo == Stereo::Anaglyph     ? v1::SHOWN_STEREO_ANAGLYPH
           : stereo == Stereo::SideBySide ? v1::SHOWN_STEREO_SIDE_BY_SIDE
           : stereo == Stereo::TopBottom  ? v1::SHOWN_STEREO_TOP_BOTTOM
                                          : v1::SHOWN_STEREO_UNSPECIFIED;
}

}  // namespace

absl::StatusOr<ViewRequest> viewFromMessage(const v1::ViewRequest& message) {
    v1::FrameData data;
    data.set_version(1);
    *data.mutable_camera() = message.camera();
    data.set_tau_pixels(message.tau_pixels());
    data.set_shading(message.shading());
    *data.mutable_look() = message.look();
    ASSIGN_OR_RETURN(const fabric::FrameData frameData, wire::fromMessage(data));
    ViewRequest view;
    view.sequence = message.sequence();
    view.frame.camera = frameData.camera;
    view.frame.tauPixels = frameData.tauPixels;
    view.frame.shading = frameData.shading;
    view.frame.look = frameData.look;
    view.isUnderground = message.underground();
    if (message.has_budget_milliseconds()) {
        RETURN_IF_ERROR(fabric::validateBudgetMilliseconds(message.budget_milliseconds()));
        view.frame.budgetMilliseconds = message.budget_milliseconds();
    }
    ASSIGN_OR_RETURN(coordinator::Shown shown, shownFromMessage(message.shown()));
    view.frame.shown = {std::move(shown)};
    view.frame.completeness = fabric::Completeness::Interactive;
    view.frame.width = std::clamp(message.width(), kMinPictureSide, kMaxPictureSide);
    view.frame.height = std::clamp(message.height(), kMinPictureSide, kMaxPictureSide);
    return view;
}

v1::ViewRequest toMessage(const ViewRequest& view) {
    fabric::FrameData frameData;
    frameData.camera = view.frame.camera;
    frameData.shading = view.frame.shading;
    frameData.look = view.frame.look;
    v1::FrameData data = wire::toMessage(frameData);
    v1::ViewRequest message;
    message.set_sequence(view.sequence);
    message.mutable_camera()->Swap(data.mutable_camera());
    message.mutable_look()->Swap(data.mutable_look());
    message.set_shading(data.shading());
    message.set_tau_pixels(view.frame.tauPixels);
    message.set_width(view.frame.width);
    message.set_height(view.frame.height);
    message.set_underground(view.isUnderground);
    if (view.frame.budgetMilliseconds)
        message.set_budget_milliseconds(*view.frame.budgetMilliseconds);
    if (view.frame.shown.empty())
        return message;
    const coordinator::Shown& shown = view.frame.shown.front();
    message.mutable_shown()->set_canvas(shown.canvas);
    message.mutable_shown()->set_segment(shown.segment);
    if (shown.eye)
        message.mutable_shown()->set_eye(toMessage(*shown.eye));
    message.mutable_shown()->set_stereo(toMessage(shown.stereo));
    return message;
}

}  // namespace eyrie::stream
