// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/named_images.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include "renderer/mesh/material.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kLongest = 1024;
/// No model shows more. Twice as many are kept meanwhile, 134 MB of the longest.
constexpr std::size_t kMost = mesh::kMaxMaterials;

/// Of what texture_files.h reads.
constexpr std::array<std::string_view, 13> kEndings = {
    "png", "jpg", "jpeg", "tga", "bmp", "gif", "psd", "pic", "ppm", "pgm", "rgb", "sgi", "bw"};

/// Of the ending at the front of `text`, in whatever case; 0 where it is none.
std::size_t lengthOfEnding(std::string_view text) {
    std::array<char, 5> word{};
    std::size_t length = 0;
    for (; length < std::min(text.size(), word.size()); ++length) {
        const auto letter = static_cast<unsigned char>(text[length]);
        if (std::isalnum(letter) == 0)
            break;
        word[length] = static_cast<char>(std::tolower(letter));
    }
    return std::ranges::count(kEndings, std::string_view(word.data(), length)) > 0 ? length : 0;
}

bool isBoundary(char c) {
    return static_cast<unsigned char>(c) < ' ' ||
           std::string_view("\"'<>;").find(c) != std::string_view::npos;
}

void keepEachOnce(std::vector<std::string>& names) {
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace

std::vector<std::string> imagesNamedIn(std::string_view bytes) {
    std::vector<std::string> names;
    for (std::size_t dot = bytes.find('.'); dot != std::string_view::npos;
         dot = bytes.find('.', dot + 1)) {
        const std::size_t length = lengthOfEnding(bytes.substr(dot + 1));
        if (length == 0)
            continue;
        std::size_t begin = dot;
        while (begin > 0 && dot - begin < kLongest && !isBoundary(bytes[begin - 1])) --begin;
        begin = std::min(bytes.find_first_not_of(' ', begin), dot);
        names.emplace_back(bytes.substr(begin, dot + 1 + length - begin));
        if (names.size() < 2 * kMost)
            continue;
        keepEachOnce(names);
        if (names.size() > kMost)
            break;
    }
    keepEachOnce(names);
    return names;
}

bool isImageName(std::string_view name) {
    const std::string_view ending = name.substr(name.rfind('.') + 1);
    return !ending.empty() && lengthOfEnding(ending) == ending.size();
}

}  // namespace eyrie::import
