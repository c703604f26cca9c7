// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/amf_text.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "renderer/import/amf_volumes.h"
#include "renderer/import/mended_text.h"

namespace eyrie::import {
namespace {

/// Calls `use` with where each element of an angle begins and ends, and its content.
template <typename Use>
void forEachAngle(std::string_view amf, const Use& use) {
    for (std::size_t at = amf.find("<r"); at != std::string_view::npos; at = amf.find("<r", at)) {
        const std::size_t begin = at;
        const std::string_view name = amf.substr(at + 1, 2);
        at += 2;
        if (name != "rx" && name != "ry" && name != "rz")
            continue;
        const std::string opening = fmt::format("<{}>", name), closing = fmt::format("</{}>", name);
        if (!amf.substr(begin).starts_with(opening))
            continue;
        const std::size_t end = amf.find(closing, begin);
        if (end == std::string_view::npos)
            return;  // which no XML reader takes
        at = end + closing.size();
        use(begin, at, amf.substr(begin + opening.size(), end - begin - opening.size()));
    }
}

bool isTurn(std::string_view degrees) {
    degrees.remove_prefix(std::min(degrees.find_first_not_of(" \t\r\n"), degrees.size()));
    double angle = 0;
    std::from_chars(degrees.data(), degrees.data() + degrees.size(), angle);
    return angle != 0;
}

/// Of which Assimp has one.
std::uint64_t countObjectsOfSeveralMeshes(std::string_view amf) {
    constexpr std::string_view kObject = "<object", kEnd = "</object", kMesh = "<mesh";
    std::uint64_t count = 0;
    for (std::size_t at = amf.find(kObject); at < amf.size(); at = amf.find(kObject, at)) {
        const std::string_view object = amf.substr(at, amf.find(kEnd, at) - at);
        const std::size_t first = object.find(kMesh);
        count += first != object.npos && object.find(kMesh, first + 1) != object.npos ? 1 : 0;
        at += object.size();
    }
    return count;
}

}  // namespace

std::optional<std::string> amfForAssimp(std::string_view amf) {
    std::optional<std::string> joined = withJoinedVolumes(amf);
    const std::string_view text = joined ? std::string_view(*joined) : amf;
    MendedText mended(text);
    forEachAngle(text, [&](std::size_t begin, std::size_t end, std::string_view) {
        mended.replace(begin, end - begin, "");
    });
    std::optional<std::string> result = mended.finish();
    return result ? result : joined;
}

std::vector<std::string> amfCaveats(std::string_view amf) {
    std::uint64_t turned = 0;
    std::size_t counted = 0;  // the end of the last instance that counts
    forEachAngle(amf, [&](std::size_t begin, std::size_t, std::string_view degrees) {
        if (begin < counted || !isTurn(degrees))
            return;
        ++turned;
        counted = std::min(amf.find("</instance", begin), amf.size());
    });
    std::vector<std::string> caveats;
    if (turned > 0)
        caveats.push_back(fmt::format(
            "left out the rotations of {} instances, which stand at their places as they were "
            "made: turn them before export",
            turned));
    if (const std::uint64_t objects = countObjectsOfSeveralMeshes(amf); objects > 0)
        caveats.push_back(fmt::format(
            "left out all but one of the meshes of {} objects, which have several: give each an "
            "object of its own",
            objects));
    return caveats;
}

}  // namespace eyrie::import
