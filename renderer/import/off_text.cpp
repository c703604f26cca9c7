// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/off_text.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "renderer/import/mended_text.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr std::uint64_t kMostCorners = 9;

/// Without a comment.
std::string_view withoutComment(std::string_view line) { return line.substr(0, line.find('#')); }

/// Takes what stands before the next blank from the front of `text`.
std::string_view takeWord(std::string_view& text, std::string_view blank = kBlank) {
    text.remove_prefix(std::min(text.find_first_not_of(blank), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(blank));
    text.remove_prefix(word.size());
    return word;
}

/// Whether the line of a vertex with a normal and a colour gives an opacity that is not whole.
bool hasOpacity(std::string_view line) {
    constexpr int kBefore = 9;
    for (int i = 0; i < kBefore; ++i) takeWord(line);
    const std::string_view word = takeWord(line);
    double opacity = 0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), opacity);
    return read.ec == std::errc() && opacity != 1 && opacity != 255;
}

std::size_t countWords(std::string_view line) {
    std::size_t count = 0;
    while (!takeWord(line).empty()) ++count;
    return count;
}

/// The lines behind a header that are not blank, and have more than a comment.
class OffLines {
public:
    explicit OffLines(std::string_view off) : rest_(off) {
        std::string_view first = takeHeaderWord();
        isColoured_ = first == "COFF";
        hasNormalsBeforeColours_ = first == "CNOFF";
        if (first.ends_with("OFF"))
            first = takeHeaderWord();
        isRead_ = count(first, vertices_) && count(takeHeaderWord(), faces_);
        takeHeaderWord();  // of edges
    }

    bool isRead() const { return isRead_; }
    /// By vertices' colours, and nothing else.
    bool isColoured() const { return isColoured_; }
    bool hasNormalsBeforeColours() const { return hasNormalsBeforeColours_; }
    std::uint64_t vertices() const { return vertices_; }
    std::uint64_t faces() const { return faces_; }

    /// Without its comment; empty at the end.
    std::string_view next() {
        while (!rest_.empty()) {
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            const std::string_view line = withoutComment(rest_.substr(0, end));
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            if (line.find_first_not_of(kBlank) != std::string_view::npos)
                return line;
        }
        return {};
    }

private:
    std::string_view takeHeaderWord() {
        constexpr std::string_view kBetween = " \t\r\n";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBetween), rest_.size()));
        while (rest_.starts_with('#')) {
            rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
            rest_.remove_prefix(std::min(rest_.find_first_not_of(kBetween), rest_.size()));
        }
        return takeWord(rest_, kBetween);
    }

    static bool count(std::string_view word, std::uint64_t& count) {
        return std::from_chars(word.data(), word.data() + word.size(), count).ec == std::errc();
    }

    std::string_view rest_;
    bool isRead_ = false, isColoured_ = false, hasNormalsBeforeColours_ = false;
    std::uint64_t vertices_ = 0, faces_ = 0;
};

}  // namespace

std::optional<std::string> offForAssimp(std::string_view off) {
    constexpr std::size_t kPlaceAndThreeColours = 6;
    OffLines lines(off);
    if (!lines.isRead() || !lines.isColoured())
        return std::nullopt;
    MendedText mended(off);
    for (std::uint64_t i = 0; i < lines.vertices(); ++i) {
        const std::string_view line = lines.next();
        if (line.empty())
            break;
        const std::size_t last = line.find_last_not_of(kBlank);
        if (countWords(line) == kPlaceAndThreeColours)
            mended.replace(static_cast<std::size_t>(line.data() - off.data()) + last + 1, 0, " 1");
    }
    return mended.finish();
}

std::vector<std::string> offCaveats(std::string_view off) {
    OffLines lines(off);
    if (!lines.isRead())
        return {};
    std::uint64_t faces = 0, coloured = 0, large = 0, more = 0, notOpaque = 0;
    std::string_view line;
    for (std::uint64_t i = 0; i < lines.vertices() && !(line = lines.next()).empty(); ++i)
        notOpaque += lines.hasNormalsBeforeColours() && hasOpacity(line) ? 1 : 0;
    for (; faces < lines.faces() && !(line = lines.next()).empty(); ++faces) {
        std::uint64_t corners = 0;
        const std::string_view word = takeWord(line);
        std::from_chars(word.data(), word.data() + word.size(), corners);
        large += corners > kMostCorners ? 1 : 0;
        coloured += countWords(line) > corners ? 1 : 0;
    }
    while (!lines.next().empty()) ++more;
    std::vector<std::string> caveats;
    if (faces < lines.faces())
        caveats.push_back(
            fmt::format("its header counts {} faces, and it has {}, as files do that were cut off: "
                        "copy or export it again if anything is missing",
                        lines.faces(), faces));
    if (notOpaque > 0)
        caveats.push_back(
            fmt::format("left out the opacity of {} vertices, which have normals, too: leave these "
                        "out (COFF), or export it as glTF",
                        notOpaque));
    if (coloured > 0)
        caveats.push_back(
            fmt::format("left out the colours of {} faces: give them to vertices", coloured));
    if (large > 0)
        caveats.push_back(
            fmt::format("left out {} faces of more than {} corners, which are not read: "
                        "triangulate them before export",
                        large, kMostCorners));
    if (more > 0)
        caveats.push_back(
            fmt::format("left out {} lines behind the {} faces that its header counts: if these "
                        "are faces, export it again",
                        more, lines.faces()));
    return caveats;
}

}  // namespace eyrie::import
