// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/for_anybody.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "fabric/shown_name.h"

namespace eyrie::coordinator {
namespace {

struct Word {
    std::string secret;
    std::string told;
};

/// The longest first: one may begin with another.
std::vector<Word> wordsOf(const fabric::Scene& scene, const std::string& id,
                          const std::string& address) {
    std::vector<Word> words;
    if (!address.empty())
        words = {{fmt::format("renderer at {}", address), id}, {address, id}};
    for (const fabric::SceneObject& object : scene.objects)
        if (object.path.find('/') != std::string::npos) {
            words.push_back({object.path, object.name});
            words.push_back({fabric::shownName(object.path), object.name});
        }
    std::ranges::stable_sort(words, std::ranges::greater(),
                             [](const Word& word) { return word.secret.size(); });
    return words;
}

}  // namespace

absl::Status forAnybody(const absl::Status& failure, const fabric::Scene& scene,
                        const std::string& id, const std::string& address) {
    const std::vector<Word> words = wordsOf(scene, id, address);
    std::string_view rest(failure.message().data(), failure.message().size());
    std::string told;
    while (!rest.empty()) {
        const auto word = std::ranges::find_if(
            words, [&](const Word& each) { return rest.starts_with(each.secret); });
        told += word == words.end() ? rest.substr(0, 1) : std::string_view(word->told);
        rest.remove_prefix(word == words.end() ? 1 : word->secret.size());
    }
    return absl::Status(failure.code(), told);
}

}  // namespace eyrie::coordinator
