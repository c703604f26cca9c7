// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/findings.h"

#include <fmt/format.h>

namespace eyrie::config {
namespace {

const char* nameOf(Finding::Kind kind) {
    switch (kind) {
        case Finding::Kind::Error:
            return "error";
        case Finding::Kind::Warning:
            return "warning";
        case Finding::Kind::OnScreen:
            break;
    }
    return "on screen only";
}

}  // namespace

void Findings::add(Finding::Kind kind, const Place& place, std::string message) {
    std::size_t& count = kind == Finding::Kind::Error ? errors_ : others_;
    if (++count <= kMost)
        all_.push_back({kind, place, std::move(message)});
}

std::string describe(const Place& place) {
    if (!place.field.empty() || place.line == 0)
        return place.field;
    return fmt::format("{}:{}", place.line, place.column);
}

std::string describe(const Findings& findings, const std::string& name) {
    std::string text;
    for (const Finding& finding : findings.all()) {
        const std::string place = describe(finding.place);
        text += fmt::format("{}:{}{} {}: {}\n", name, place, place.empty() ? "" : ":",
                            nameOf(finding.kind), finding.message);
    }
    if (findings.errors() > Findings::kMost)
        text += fmt::format("{}: and {} errors more\n", name, findings.errors() - Findings::kMost);
    return text;
}

}  // namespace eyrie::config
