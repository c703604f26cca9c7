// SPDX-License-Identifier: Apache-2.0
#include "cli/all_pictures.h"

#include <filesystem>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "coordinator/config/named.h"
#include "coordinator/config/resolved.h"

namespace eyrie::cli {
namespace {

using compound::Eye;

bool isPlain(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9') || letter == '-';
}

/// As a part of a file's name.
std::string fileName(const std::string& name, std::size_t position) {
    if (name.empty())
        return fmt::format("{}", position);
    std::string plain;
    for (const char letter : name) plain += isPlain(letter) ? letter : '_';
    return plain;
}

/// What compounds show of a segment; nothing where it shows nothing.
config::Eyes eyesOf(const config::ResolvedConfiguration& resolved, std::size_t canvas,
                    std::size_t segment) {
    config::Eyes eyes;
    for (const config::ResolvedCompound& each : resolved.compounds) {
        if (!each.destination)
            continue;
        const config::Destination& shown = resolved.destinations[*each.destination];
        if (shown.isShown && shown.index.canvas == canvas && shown.index.segment == segment)
            eyes = {eyes.cyclop || each.eyes.cyclop, eyes.left || each.eyes.left,
                    eyes.right || each.eyes.right};
    }
    return eyes;
}

}  // namespace

std::vector<NamedPicture> allPictures(const config::Configuration& configuration) {
    config::Findings findings;
    const config::ResolvedConfiguration resolved = config::resolve(configuration, findings);
    std::vector<NamedPicture> pictures;
    std::set<std::string> names;
    for (std::size_t i = 0; i < configuration.canvases.size(); ++i) {
        const config::Canvas& canvas = configuration.canvases[i];
        for (std::size_t j = 0; j < canvas.segments.size(); ++j) {
            const config::Eyes eyes = eyesOf(resolved, i, j);
            std::string name = fmt::format("{}.{}", fileName(canvas.name, i),
                                           fileName(canvas.segments[j].name, j));
            while (!names.insert(name).second) name += "_";
            const coordinator::Shown shown{
                config::positionName(i), config::positionName(j), {}, {}};
            for (const auto& [isShown, eye, word] :
                 {std::tuple(eyes.cyclop, Eye::Cyclop, ""),
                  std::tuple(eyes.left, Eye::Left, ".left"),
                  std::tuple(eyes.right, Eye::Right, ".right")}) {
                if (!isShown)
                    continue;
                pictures.push_back({name + word, shown});
                pictures.back().shown.eye = eye;
            }
        }
    }
    return pictures;
}

std::string pathOf(const std::string& path, std::string_view name) {
    const std::filesystem::path whole(path);
    const std::string file =
        fmt::format("{}.{}{}", whole.stem().string(), name, whole.extension().string());
    return (whole.parent_path() / file).string();
}

}  // namespace eyrie::cli
