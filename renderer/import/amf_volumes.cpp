// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/amf_volumes.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "renderer/import/mended_text.h"
#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kNoColour = "<color><r>1</r><g>1</g><b>1</b></color>";
/// Of a colour's text, which is copied into each triangle: formulas, which are not read, have more.
constexpr std::size_t kLongestColour = 256;

/// Where an element is in a text.
struct Element {
    std::size_t begin = 0;
    std::size_t contentBegin = 0;
    std::size_t contentEnd = 0;
    std::size_t end = 0;

    /// Its own end, with nothing in it.
    bool isTagAlone() const { return contentEnd == end; }
    std::string_view tagOf(std::string_view text) const {
        return text.substr(begin, contentBegin - begin);
    }
    std::string_view contentOf(std::string_view text) const {
        return text.substr(contentBegin, contentEnd - contentBegin);
    }
};

/// The first from `at` on that has an end.
std::optional<Element> findElement(std::string_view text, std::string_view name, std::size_t at) {
    constexpr std::string_view kBehindName = " \t\r\n>/";
    const std::string opening = fmt::format("<{}", name), closing = fmt::format("</{}>", name);
    Element element;
    do {
        element.begin = text.find(opening, at);
        at = element.begin + opening.size();
        if (element.begin == text.npos || at >= text.size())
            return std::nullopt;
    } while (kBehindName.find(text[at]) == kBehindName.npos);
    element.contentBegin = element.begin + endOfTag(text.substr(element.begin));
    if (element.tagOf(text).ends_with("/>")) {
        element.contentEnd = element.end = element.contentBegin;
        return element;
    }
    element.contentEnd = text.find(closing, element.contentBegin);
    if (element.contentEnd == text.npos)
        return std::nullopt;
    element.end = element.contentEnd + closing.size();
    return element;
}

template <typename Use>
void forEachElement(std::string_view text, std::string_view name, const Use& use) {
    for (auto element = findElement(text, name, 0); element;
         element = findElement(text, name, element->end))
        use(*element);
}

/// The text of a colour before anything called `behind`; empty without one.
std::string_view colourIn(std::string_view text, std::string_view behind) {
    const auto colour = findElement(text.substr(0, text.find(behind)), "color", 0);
    return !colour || colour->end - colour->begin > kLongestColour
               ? std::string_view()
               : text.substr(colour->begin, colour->end - colour->begin);
}

class Joining {
public:
    explicit Joining(std::string_view amf) : amf_(amf), mended_(amf) {
        forEachElement(amf, "material", [&](const Element& material) {
            ofMaterials_[xmlAttribute(material.tagOf(amf_), "id")] =
                colourIn(material.contentOf(amf_), "</material");
        });
    }

    std::optional<std::string> run() {
        forEachElement(amf_, "object", [&](const Element& object) {
            const std::string_view colour = colourIn(object.contentOf(amf_), "<mesh");
            forEachElement(object.contentOf(amf_), "mesh", [&](const Element& mesh) {
                join(mesh.contentOf(object.contentOf(amf_)), colour);
            });
        });
        return mended_.finish();
    }

private:
    std::size_t placeOf(std::string_view part) const {
        return static_cast<std::size_t>(part.data() - amf_.data());
    }

    std::string_view colourOf(std::string_view mesh, const Element& volume,
                              std::string_view ofObject) const {
        if (const std::string_view own = colourIn(volume.contentOf(mesh), "<triangle");
            !own.empty())
            return own;
        const auto material = ofMaterials_.find(xmlAttribute(volume.tagOf(mesh), "materialid"));
        return material != ofMaterials_.end() && !material->second.empty() ? material->second
                                                                           : ofObject;
    }

    void join(std::string_view mesh, std::string_view ofObject) {
        std::vector<Element> volumes;
        forEachElement(mesh, "volume", [&](const Element& volume) {
            if (!volume.isTagAlone())
                volumes.push_back(volume);
        });
        if (volumes.size() < 2)
            return;
        const bool areOfVertices = !colourIn(mesh, "<volume").empty();
        const std::string_view first = colourOf(mesh, volumes[0], ofObject);
        for (std::size_t i = 1; i < volumes.size(); ++i) {
            const std::string_view content = volumes[i].contentOf(mesh);
            const std::size_t triangles = std::min(content.find("<triangle"), content.size());
            const std::size_t before = volumes[i - 1].contentEnd;
            mended_.replace(placeOf(mesh) + before, volumes[i].contentBegin + triangles - before,
                            "");
            const std::string_view colour = colourOf(mesh, volumes[i], ofObject);
            if (!areOfVertices && colour != first)
                colourTriangles(content.substr(triangles), colour.empty() ? kNoColour : colour);
        }
    }

    void colourTriangles(std::string_view triangles, std::string_view colour) {
        forEachElement(triangles, "triangle", [&](const Element& triangle) {
            const std::string_view content = triangle.contentOf(triangles);
            if (!triangle.isTagAlone() && content.find("<color") == content.npos)
                mended_.replace(placeOf(content), 0, colour);
        });
    }

    std::string_view amf_;
    MendedText mended_;
    std::map<std::string_view, std::string_view> ofMaterials_;  ///< by their numbers
};

}  // namespace

std::optional<std::string> withJoinedVolumes(std::string_view amf) { return Joining(amf).run(); }

}  // namespace eyrie::import
