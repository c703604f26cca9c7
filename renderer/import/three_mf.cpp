// SPDX-License-Identifier: Apache-2.0
// 3MF Consortium, "3D Manufacturing Format: Core Specification" 1.3, "Materials and Properties
// Extension" 1.2, "Production Extension" 1.1.
#include "renderer/import/three_mf.h"

#include <optional>
#include <set>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "access/printable.h"
#include "fabric/status.h"
#include "renderer/import/xml_tag.h"
#include "renderer/import/zip_parts.h"

namespace eyrie::import {
namespace {

/// What a tag is of; of one that ends an element with '/'. The core's have no prefix.
std::string_view kindOf(std::string_view tag) {
    return tag.substr(1, tag.find_first_of(" \t\r\n/>", 2) - 1);
}

template <typename Use>
absl::Status forEachTag(std::string_view xml, const Use& use) {
    constexpr std::string_view kComment = "<!--", kEndOfComment = "-->";
    for (std::size_t at = xml.find('<'); at < xml.size(); at = xml.find('<', at)) {
        if (xml.substr(at).starts_with(kComment)) {
            at = xml.find(kEndOfComment, at);
            continue;
        }
        const std::string_view tag = xml.substr(at, endOfTag(xml.substr(at)));
        RETURN_IF_ERROR(use(tag));
        at += tag.size();
    }
    return absl::OkStatus();
}

/// A member of a group of properties.
struct Property {
    std::string_view group;
    std::string_view index;

    bool operator==(const Property&) const = default;
};

/// Counts objects, tag by tag.
class Colours {
public:
    void add(std::string_view kind, std::string_view tag) {
        if (kind == "basematerials")
            baseMaterials_.emplace(xmlAttribute(tag, "id"));
        else if (kind == "object")
            begin(tag);
        else if (kind == "triangle")
            addTriangle(tag);
        else if (kind == "/object")
            recoloured_ += isRecoloured_ ? 1 : 0;
    }

    std::uint64_t recoloured() const { return recoloured_; }

private:
    void begin(std::string_view tag) {
        ofObject_ = {xmlAttribute(tag, "pid"), xmlAttribute(tag, "pindex")};
        used_.reset();
        isRecoloured_ = false;
    }

    void addTriangle(std::string_view tag) {
        const std::string_view group = xmlAttribute(tag, "pid"), first = xmlAttribute(tag, "p1");
        const Property property =
            first.empty() ? ofObject_ : Property{group.empty() ? ofObject_.group : group, first};
        const auto isOther = [&](const char* corner) {
            const std::string_view index = xmlAttribute(tag, corner);
            return !index.empty() && index != first;
        };
        const bool isKnown = property.group.empty() || baseMaterials_.contains(property.group);
        isRecoloured_ = isRecoloured_ || !isKnown || isOther("p2") || isOther("p3") ||
                        property != used_.value_or(property);
        used_ = property;
    }

    std::set<std::string, std::less<>> baseMaterials_;
    Property ofObject_;
    std::optional<Property> used_;
    bool isRecoloured_ = false;
    std::uint64_t recoloured_ = 0;
};

/// As the attribute `path` is called in the namespace of the Production Extension.
std::string nameOfPath(std::string_view model) {
    constexpr std::string_view kPrefix = "xmlns:";
    const std::size_t uri =
        model.find("http://schemas.microsoft.com/3dmanufacturing/production/2015/06");
    const std::size_t at = uri == std::string_view::npos ? uri : model.rfind(kPrefix, uri);
    if (at == std::string_view::npos)
        return "p:path";
    const std::string_view prefix = model.substr(at + kPrefix.size());
    return std::string(prefix.substr(0, prefix.find('='))) + ":path";
}

}  // namespace

absl::StatusOr<std::uint64_t> countRecoloured3mfObjects(std::string_view model) {
    const std::string path = nameOfPath(model);
    Colours colours;
    RETURN_IF_ERROR(forEachTag(model, [&](std::string_view tag) {
        const std::string_view kind = kindOf(tag);
        const bool isPlaced = kind == "component" || kind == "item";
        const std::string_view part = isPlaced ? xmlAttribute(tag, path) : std::string_view();
        if (!part.empty())
            return absl::InvalidArgumentError(fmt::format(
                "its object {} is in another part of it, '{}' (production extension), which is not "
                "read; export it in one part, that is without that extension, or as STL or glTF",
                access::printable(xmlAttribute(tag, "objectid")), access::printable(part)));
        colours.add(kind, tag);
        return absl::OkStatus();
    }));
    return colours.recoloured();
}

absl::StatusOr<std::vector<std::string>> notesOf3mf(const std::string& path) {
    std::uint64_t recoloured = 0;
    RETURN_IF_ERROR(forEachZipPart(path, ".model", [&](std::string_view model) {
        const auto objects = countRecoloured3mfObjects(model);
        recoloured += objects.value_or(0);
        return objects.status();
    }));
    if (recoloured == 0)
        return std::vector<std::string>();
    return std::vector<std::string>{fmt::format(
        "left out colours of {} objects: those of triangles and of groups of colours or textures "
        "are not read, and an object has that of one base material; export it as glTF to keep them",
        recoloured)};
}

}  // namespace eyrie::import
