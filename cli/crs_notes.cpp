// SPDX-License-Identifier: Apache-2.0
#include "cli/crs_notes.h"

#include <algorithm>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/crs_text.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli {

std::string crsName(const std::string& wkt) {
    const std::size_t begin = wkt.find('"');
    const std::size_t end = wkt.find('"', begin + 1);
    return begin == std::string::npos || end == std::string::npos
               ? "none"
               : wkt.substr(begin + 1, end - begin - 1);
}

absl::StatusOr<std::vector<std::string>> crsNotes(const fabric::Scene& scene,
                                                  const page::SourceOptions& sources) {
    std::vector<std::string> notes;
    if (std::ranges::count(scene.objects, fabric::ObjectKind::Terrain, &fabric::SceneObject::kind) <
        2)
        return notes;
    std::string first;  // terrain's name
    std::vector<std::string> known;
    for (const fabric::SceneObject& object : scene.objects) {
        if (object.kind != fabric::ObjectKind::Terrain)
            continue;
        ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(object.path, sources));
        const std::string& crs = file->index().crsWkt;
        const auto isKnown = [&](const std::string& one) { return import::isSameCrs(one, crs); };
        if (crs.empty() || std::ranges::any_of(known, isKnown))
            continue;
        if (known.empty())
            first = object.name;
        else
            notes.push_back(fmt::format(
                "{} is in {} and {} in {}: each is shown at its own coordinates, so they need not "
                "lie beside each other as they do on the earth; `eyrie import terrain` makes one "
                "terrain of both sources",
                object.name, crsName(crs), first, crsName(known.front())));
        known.push_back(crs);
    }
    return notes;
}

}  // namespace eyrie::cli
