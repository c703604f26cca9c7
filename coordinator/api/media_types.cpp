// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/media_types.h"

#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::api {
namespace {

/// Not plain JSON, which is how all of the answer comes.
constexpr std::string_view kSummary = "application/vnd.eyrie.summary+json";
constexpr std::string_view kTable = "text/csv";
constexpr std::string_view kPage = "text/html";
constexpr std::string_view kPng = "image/png";
constexpr std::string_view kJpeg = "image/jpeg";
constexpr std::string_view kFloatMap = "image/x-portable-floatmap";
constexpr std::string_view kTrace = "application/vnd.eyrie.trace+json";
constexpr std::string_view kRaw = "application/octet-stream";

std::string_view typeOf(const v1::GetReportResponse& report) {
    switch (report.file()) {
        case v1::REPORT_FILE_FRAMES:
        case v1::REPORT_FILE_ERRORS:
            return kTable;
        case v1::REPORT_FILE_PAGE:
            return kPage;
        default:
            return kSummary;
    }
}

std::string_view typeOf(const v1::RenderImageResponse& image) {
    switch (image.format()) {
        case v1::IMAGE_FORMAT_RAW:
            return kRaw;
        case v1::IMAGE_FORMAT_DEPTH:
            return kFloatMap;
        case v1::IMAGE_FORMAT_JPEG:
            return kJpeg;
        default:
            return kPng;
    }
}

}  // namespace

std::string mediaTypeOf(const google::protobuf::Message& answer) {
    if (const auto* report = dynamic_cast<const v1::GetReportResponse*>(&answer))
        return std::string(typeOf(*report));
    if (const auto* image = dynamic_cast<const v1::RenderImageResponse*>(&answer))
        return std::string(typeOf(*image));
    return std::string(kTrace);
}

std::vector<std::string_view> mediaTypesOf(const google::protobuf::Descriptor& answer) {
    if (answer.full_name() == v1::GetReportResponse::descriptor()->full_name())
        return {kSummary, kTable, kPage};
    if (answer.full_name() == v1::GetTraceResponse::descriptor()->full_name())
        return {kTrace};
    return {kPng, kJpeg, kRaw, kFloatMap};
}

std::vector<std::pair<std::string_view, std::string_view>> headersOfBytes(
    const google::protobuf::Descriptor& answer) {
    if (answer.full_name() == v1::GetReportResponse::descriptor()->full_name())
        return {{"Content-Disposition", "The file's name: it is to be saved, not shown."}};
    if (answer.full_name() == v1::RenderImageResponse::descriptor()->full_name())
        return {{"Eyrie-Tau-Achieved",
                 "Of the picture's bytes: its statistics.tauAchieved, Infinity where there is no "
                 "bound."},
                {"Eyrie-Complete", "Of the picture's bytes: its statistics.complete."},
                {"Eyrie-Revision", "Of the picture's bytes: its revision."}};
    return {};
}

}  // namespace eyrie::api
