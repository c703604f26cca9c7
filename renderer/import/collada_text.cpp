// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/collada_text.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

/// Calls `use` with each tag that begins with `opening`, and where it begins.
template <typename Use>
void forEachTag(std::string_view xml, std::string_view opening, const Use& use) {
    for (std::size_t at = xml.find(opening); at != std::string_view::npos;) {
        const std::string_view tag = xml.substr(at, endOfTag(xml.substr(at)));
        use(tag, at);
        at = xml.find(opening, at + tag.size());
    }
}

/// A number of a set; 0 where the attribute has none, as the format has it.
unsigned int numberOf(std::string_view value) {
    unsigned int number = 0;
    std::from_chars(value.data(), value.data() + value.size(), number);
    return number;
}

std::set<unsigned int> setsOf(std::string_view collada) {
    std::set<unsigned int> sets;
    forEachTag(collada, "<input ", [&](std::string_view tag, std::size_t) {
        if (xmlAttribute(tag, "semantic") == "TEXCOORD")
            sets.insert(numberOf(xmlAttribute(tag, "set")));
    });
    return sets;
}

/// The set that each name stands for. A name that stands for several has the first.
std::map<std::string_view, unsigned int> bindingsOf(std::string_view collada) {
    std::map<std::string_view, unsigned int> bindings;
    forEachTag(collada, "<bind_vertex_input ", [&](std::string_view tag, std::size_t) {
        if (xmlAttribute(tag, "input_semantic") == "TEXCOORD")
            bindings.emplace(xmlAttribute(tag, "semantic"),
                             numberOf(xmlAttribute(tag, "input_set")));
    });
    return bindings;
}

}  // namespace

std::string colladaForAssimp(std::string_view collada) {
    const std::set<unsigned int> sets = setsOf(collada);
    const std::map<std::string_view, unsigned int> bindings = bindingsOf(collada);
    std::string result;
    std::size_t done = 0;
    forEachTag(collada, "<texture ", [&](std::string_view tag, std::size_t at) {
        const std::string_view name = xmlAttribute(tag, "texcoord");
        const auto bound = bindings.find(name);
        const auto set = bound != bindings.end() ? sets.find(bound->second) : sets.end();
        if (name.empty() || set == sets.end())
            return;
        result += collada.substr(done, at - done);
        result += withValue(tag, name, fmt::format("{}", std::distance(sets.begin(), set)));
        done = at + tag.size();
    });
    return result += collada.substr(done);
}

}  // namespace eyrie::import
