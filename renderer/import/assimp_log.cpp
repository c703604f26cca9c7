// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_log.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <fmt/format.h>

#include "access/printable.h"

namespace eyrie::import {
namespace {

/// Messages that are told; files can be full of others.
constexpr std::size_t kMostTold = 4;
constexpr std::size_t kMostKept = 256;

/// "Warn,  T0: what it is\n".
std::string_view textOf(std::string_view line) {
    const std::size_t colon = line.find(": ");
    std::string_view text = colon == std::string_view::npos ? line : line.substr(colon + 2);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0)
        text.remove_suffix(1);
    return text;
}

/// Of what is drawn. Animations, bones, lines and the like are not, nor what nobody asked for; what
/// STL and OFF lack at their ends their caveats tell.
bool tellsOfALoss(std::string_view text) {
    constexpr std::array kLosses = {"dropped",
                                    "kipping",
                                    "discarding",
                                    "invalid index",
                                    "index overflow",
                                    "out-of-range",
                                    "out of range",
                                    "gnoring",
                                    "will be ignored",
                                    "IFC: failed to",
                                    "not implemented",
                                    "not currently implemented",
                                    "unsupported boolean",
                                    "unsupported primitive",
                                    "did not encounter",
                                    "nexpected EOF"};
    constexpr std::array kOthers = {
        "nimation", "bone",   "Bone", "umbNail",     "OptimizeMeshes",      "property", "Property",
        "settings", "Weight", "TCB",  "IfcPolyline", "lines with the same", "endsolid"};
    const auto has = [&](const char* words) { return text.find(words) != std::string_view::npos; };
    return std::ranges::any_of(kLosses, has) && std::ranges::none_of(kOthers, has);
}

/// Without the numbers of what it tells of, by which each would be told.
std::string kindOf(std::string_view text) {
    std::string kind(text);
    std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) != 0; });
    return kind;
}

}  // namespace

class AssimpLog::Listener : public Assimp::LogStream {
public:
    struct Heard {
        std::string first;
        std::uint64_t times = 1;  ///< or more: what is repeated at once is written once
    };

    void write(const char* message) override {
        const std::string_view text = textOf(message);
        if (!tellsOfALoss(text))
            return;
        std::string kind = kindOf(text);
        if (const auto known = heard_.find(kind); known != heard_.end())
            ++known->second.times;
        else if (heard_.size() < kMostKept)
            heard_.try_emplace(std::move(kind), Heard{std::string(text)});
    }

    const std::map<std::string, Heard>& heard() const { return heard_; }

private:
    std::map<std::string, Heard> heard_;  ///< by their kinds
};

AssimpLog::AssimpLog() : listener_(new Listener) {
    using Assimp::Logger;
    Assimp::DefaultLogger::create("", Logger::NORMAL, 0)
        ->attachStream(listener_, Logger::Warn | Logger::Err);
}

AssimpLog::~AssimpLog() { Assimp::DefaultLogger::kill(); }

std::vector<std::string> AssimpLog::notes() const {
    std::vector<std::string> notes;
    for (const auto& [kind, heard] : listener_->heard()) {
        if (notes.size() == kMostTold) {
            notes.push_back(fmt::format("left out more, for {} more reasons that its reader gives",
                                        listener_->heard().size() - kMostTold));
            break;
        }
        notes.push_back(
            fmt::format("left out something; its reader says{}: {}",
                        heard.times > 1 ? fmt::format(" ({} times or more)", heard.times) : "",
                        access::printable(heard.first)));
    }
    return notes;
}

}  // namespace eyrie::import
