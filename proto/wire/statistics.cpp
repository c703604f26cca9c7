// SPDX-License-Identifier: Apache-2.0
#include "wire/statistics.h"

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "eyrie/v1/statistics.pb.h"
#include "fabric/status.h"

namespace eyrie::wire {
namespace {

constexpr std::size_t kMaxTextBytes = 1024;

absl::Status checkFinite(double value, std::string_view field) {
    if (value >= 0 && std::isfinite(value))
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("statistics.{} is {}; it must be 0 or more and finite", field, value));
}

v1::StageMilliseconds toMessage(const fabric::StageMilliseconds& milliseconds) {
    v1::StageMilliseconds message;
    message.set_cull(milliseconds.cull);
    message.set_draw(milliseconds.draw);
    message.set_readback(milliseconds.readback);
    message.set_encode(milliseconds.encode);
    message.set_total(milliseconds.total);
    message.set_vertices(milliseconds.vertices);
    message.set_fill(milliseconds.fill);
    return message;
}

absl::StatusOr<fabric::StageMilliseconds> fromMessage(const v1::StageMilliseconds& message) {
    RETURN_IF_ERROR(checkFinite(message.cull(), "milliseconds.cull"));
    RETURN_IF_ERROR(checkFinite(message.draw(), "milliseconds.draw"));
    RETURN_IF_ERROR(checkFinite(message.readback(), "milliseconds.readback"));
    RETURN_IF_ERROR(checkFinite(message.encode(), "milliseconds.encode"));
    RETURN_IF_ERROR(checkFinite(message.total(), "milliseconds.total"));
    RETURN_IF_ERROR(checkFinite(message.vertices(), "milliseconds.vertices"));
    RETURN_IF_ERROR(checkFinite(message.fill(), "milliseconds.fill"));
    return fabric::StageMilliseconds{message.cull(),   message.draw(),  message.readback(),
                                     message.encode(), message.total(), message.vertices(),
                                     message.fill()};
}

absl::StatusOr<fabric::BudgetUse> fromMessage(const v1::BudgetUse& message) {
    RETURN_IF_ERROR(checkFinite(message.milliseconds(), "budget.milliseconds"));
    RETURN_IF_ERROR(checkFinite(message.predicted_milliseconds(), "budget.predicted_milliseconds"));
    RETURN_IF_ERROR(checkFinite(message.tau_pixels(), "budget.tau_pixels"));
    if (!(message.covered() >= 0 && message.covered() <= 1))
        return absl::InvalidArgumentError(fmt::format(
            "statistics.budget.covered is {}; it must be from 0 to 1", message.covered()));
    return fabric::BudgetUse{message.milliseconds(), message.predicted_milliseconds(),
                             message.tau_pixels(), message.triangles(), message.covered()};
}

absl::Status checkText(const std::string& text, std::string_view field) {
    if (text.size() <= kMaxTextBytes)
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format("device.{} has {} bytes; at most {} are allowed",
                                                  field, text.size(), kMaxTextBytes));
}

}  // namespace

v1::FrameStatistics toMessage(const fabric::FrameStatistics& statistics) {
    v1::FrameStatistics message;
    message.set_tau_asked(statistics.tauAskedPixels);
    message.set_tau_achieved(statistics.tauAchievedPixels);
    message.set_complete(statistics.complete);
    message.set_triangles(statistics.triangles);
    message.set_points(statistics.points);
    message.set_nodes(statistics.nodes);
    message.set_nodes_hidden(statistics.nodesHidden);
    message.set_pages_loaded(statistics.pagesLoaded);
    message.set_bytes_loaded(statistics.bytesLoaded);
    message.set_pages_missing(statistics.pagesMissing);
    message.set_pages_failed(statistics.pagesFailed);
    message.set_memory_raised_tau(statistics.memoryRaisedTau);
    message.set_tiles_decoded_on_gpu(statistics.tilesDecodedOnGpu);
    message.set_normal_error_degrees(statistics.normalErrorDegrees);
    message.set_normal_error_mean_degrees(statistics.normalErrorMeanDegrees);
    *message.mutable_milliseconds() = toMessage(statistics.milliseconds);
    if (statistics.budget) {
        v1::BudgetUse& budget = *message.mutable_budget();
        budget.set_milliseconds(statistics.budget->milliseconds);
        budget.set_predicted_milliseconds(statistics.budget->predictedMilliseconds);
        budget.set_tau_pixels(statistics.budget->tauPixels);
        budget.set_triangles(statistics.budget->triangles);
        budget.set_covered(statistics.budget->covered);
    }
    return message;
}

absl::StatusOr<fabric::FrameStatistics> fromMessage(const v1::FrameStatistics& message) {
    fabric::FrameStatistics statistics;
    RETURN_IF_ERROR(checkFinite(message.tau_asked(), "tau_asked"));
    if (!(message.tau_achieved() >= 0))
        return absl::InvalidArgumentError(fmt::format(
            "statistics.tau_achieved is {}; it must be 0 or more", message.tau_achieved()));
    statistics.tauAskedPixels = message.tau_asked();
    statistics.tauAchievedPixels = message.tau_achieved();
    statistics.complete = message.complete();
    statistics.triangles = message.triangles();
    statistics.points = message.points();
    statistics.nodes = message.nodes();
    statistics.nodesHidden = message.nodes_hidden();
    statistics.pagesLoaded = message.pages_loaded();
    statistics.bytesLoaded = message.bytes_loaded();
    statistics.pagesMissing = message.pages_missing();
    statistics.pagesFailed = message.pages_failed();
    statistics.memoryRaisedTau = message.memory_raised_tau();
    statistics.tilesDecodedOnGpu = message.tiles_decoded_on_gpu();
    if (statistics.pagesFailed > statistics.pagesMissing)
        return absl::InvalidArgumentError(
            fmt::format("statistics.pages_failed is {}; it must be at most pages_missing, {}",
                        statistics.pagesFailed, statistics.pagesMissing));
    if (!(message.normal_error_degrees() >= 0 && message.normal_error_degrees() <= 180))
        return absl::InvalidArgumentError(
            fmt::format("statistics.normal_error_degrees is {}; it must be 0 to 180",
                        message.normal_error_degrees()));
    if (!(message.normal_error_mean_degrees() >= 0 &&
          message.normal_error_mean_degrees() <= message.normal_error_degrees()))
        return absl::InvalidArgumentError(fmt::format(
            "statistics.normal_error_mean_degrees is {}; it must be 0 to normal_error_degrees, {}",
            message.normal_error_mean_degrees(), message.normal_error_degrees()));
    statistics.normalErrorDegrees = message.normal_error_degrees();
    statistics.normalErrorMeanDegrees = message.normal_error_mean_degrees();
    ASSIGN_OR_RETURN(statistics.milliseconds, fromMessage(message.milliseconds()));
    if (message.has_budget()) {
        ASSIGN_OR_RETURN(statistics.budget, fromMessage(message.budget()));
    }
    return statistics;
}

v1::DeviceInfo toMessage(const fabric::DeviceInfo& device) {
    v1::DeviceInfo message;
    message.set_vendor(device.vendor);
    message.set_device(device.renderer);
    message.set_driver(device.driver);
    message.set_platform(device.platform);
    message.set_software(device.software);
    return message;
}

absl::StatusOr<fabric::DeviceInfo> fromMessage(const v1::DeviceInfo& message) {
    RETURN_IF_ERROR(checkText(message.vendor(), "vendor"));
    RETURN_IF_ERROR(checkText(message.device(), "device"));
    RETURN_IF_ERROR(checkText(message.driver(), "driver"));
    RETURN_IF_ERROR(checkText(message.platform(), "platform"));
    return fabric::DeviceInfo{message.vendor(), message.device(), message.driver(),
                              message.platform(), message.software()};
}

}  // namespace eyrie::wire
