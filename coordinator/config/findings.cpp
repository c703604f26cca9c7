// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/findings.h"

#include <algorithm>

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
            return "on screen only";
        case Finding::Kind::Note:
            break;
    }
    return "note";
}

bool hasPlaceOfItsOwn(const Finding& finding) {
    return finding.kind == Finding::Kind::Error || finding.kind == Finding::Kind::Warning;
}

bool areAlike(const Finding& a, const Finding& b) {
    return a.kind == b.kind && a.message == b.message;
}

std::string line(const Finding& finding, const std::string& name, std::size_t places) {
    const std::string place = describe(finding.place);
    return fmt::format("{}:{}{} {}: {}{}\n", name, place, place.empty() ? "" : ":",
                       nameOf(finding.kind), finding.message,
                       places > 1 ? fmt::format(" (here and in {} more place{})", places - 1,
                                                places == 2 ? "" : "s")
                                  : "");
}

}  // namespace

void Findings::add(Finding::Kind kind, const Place& place, std::string message) {
    if (++counts_[static_cast<std::size_t>(kind)] <= kMost)
        all_.push_back({kind, place, std::move(message)});
}

std::string describe(const Place& place) {
    if (!place.field.empty() || place.line == 0)
        return place.field;
    return fmt::format("{}:{}", place.line, place.column);
}

std::string describe(const Findings& findings, const std::string& name, Finding::Kind first,
                     Finding::Kind last) {
    std::string text;
    std::vector<Finding> alike;
    std::vector<std::size_t> places;
    for (const Finding& finding : findings.all()) {
        if (finding.kind < first || finding.kind > last)
            continue;
        if (hasPlaceOfItsOwn(finding)) {
            text += line(finding, name, 1);
            continue;
        }
        const auto before = std::ranges::find_if(
            alike, [&](const Finding& each) { return areAlike(each, finding); });
        if (before == alike.end()) {
            alike.push_back(finding);
            places.push_back(1);
        } else {
            ++places[static_cast<std::size_t>(before - alike.begin())];
        }
    }
    for (std::size_t i = 0; i < alike.size(); ++i) text += line(alike[i], name, places[i]);
    if (first == Finding::Kind::Error && findings.errors() > Findings::kMost)
        text += fmt::format("{}: and {} errors more\n", name, findings.errors() - Findings::kMost);
    return text;
}

}  // namespace eyrie::config
