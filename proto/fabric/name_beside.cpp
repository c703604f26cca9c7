// SPDX-License-Identifier: Apache-2.0
#include "fabric/name_beside.h"

#include <climits>
#include <cstdint>

#include <fmt/format.h>

namespace eyrie::fabric {
namespace {

/// FNV-1a.
std::uint64_t hashOf(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

/// Its first bytes, at most so many, without a part of a character of UTF-8.
std::string_view beginningOf(std::string_view text, std::size_t most) {
    const auto isInside = [&](std::size_t at) {
        return at > 0 && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80;
    };
    while (isInside(most)) --most;
    return text.substr(0, most);
}

}  // namespace

std::string nameBeside(const std::string& path, std::string_view ending) {
    const std::size_t slash = path.rfind('/');
    const std::size_t folder = slash == std::string::npos ? 0 : slash + 1;
    const std::string_view name = std::string_view(path).substr(folder);
    std::string beside = path;
    if (name.size() + ending.size() > NAME_MAX) {
        const std::string hash = fmt::format("~{:016x}", hashOf(name));
        beside.resize(folder);
        beside += beginningOf(name, NAME_MAX - ending.size() - hash.size());
        beside += hash;
    }
    return beside.append(ending);
}

}  // namespace eyrie::fabric
