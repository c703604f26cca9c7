// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/off_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

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

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line))
        words.push_back(word);
    return words;
}

/// As far as numbers are rounded. Vertices that no face has may have none.
bool isNormal(std::span<const std::string_view> words) {
    constexpr double kRounding = 0.02;
    double square = 0;
    for (const std::string_view word : words) {
        double number = 0;
        std::from_chars(word.data(), word.data() + word.size(), number);
        square += number * number;
    }
    return square == 0 || std::abs(std::sqrt(square) - 1) < kRounding;
}

/// What the header's first word says of vertices.
struct OffKind {
    bool hasPlaces = false;  ///< on a texture
    bool hasColours = false;
    bool hasNormals = false;
    bool isNc = false;     ///< which some have as it stands, and MeshLab with colours first
    bool isOther = false;  ///< has something else, too

    explicit OffKind(std::string_view word) {
        constexpr std::string_view kEnd = "OFF";
        isOther = !word.ends_with(kEnd);
        isNc = word == "NCOFF";
        while (!isOther && word != kEnd) {
            const bool isOfPlaces = word.starts_with("ST");
            isOther =
                !isOfPlaces && word[0] != 'C' && (word[0] != 'N' || (word[1] == 'C' && !isNc));
            hasPlaces = hasPlaces || isOfPlaces;
            hasColours = hasColours || word[0] == 'C';
            hasNormals = hasNormals || word[0] == 'N';
            word.remove_prefix(isOfPlaces ? 2 : 1);
        }
    }

    /// In the order that the format wants, and Assimp needs.
    std::string word() const {
        return fmt::format("{}{}{}OFF", hasPlaces ? "ST" : "", hasColours ? "C" : "",
                           hasNormals ? "N" : "");
    }
};

/// The lines behind a header that are not blank, and have more than a comment.
class OffLines {
public:
    explicit OffLines(std::string_view off) : rest_(off) {
        std::string_view first = takeHeaderWord();
        word_ = first;
        if (first.ends_with("OFF"))
            first = takeHeaderWord();
        isRead_ = count(first, vertices_) && count(takeHeaderWord(), faces_);
        takeHeaderWord();  // of edges
    }

    bool isRead() const { return isRead_; }
    /// The first of the header.
    std::string_view word() const { return word_; }
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
    std::string_view word_;
    bool isRead_ = false;
    std::uint64_t vertices_ = 0, faces_ = 0;
};

/// In which order vertices have what "NC" stands for.
enum class NcOrder { Unknown, NormalsFirst, ColoursFirst };

constexpr std::size_t kPlace = 3, kNormal = 3, kLeastOfNc = 9, kMostOfNc = 10;

/// By what is of a normal's length in all of them; as the word has it where both may be.
NcOrder ncOrderOf(OffLines lines) {
    bool areFirst = true, areLast = true;
    std::string_view line;
    for (std::uint64_t i = 0; i < lines.vertices() && !(line = lines.next()).empty(); ++i) {
        const std::vector<std::string_view> words = wordsOf(line);
        if (words.size() < kLeastOfNc || words.size() > kMostOfNc)
            return NcOrder::Unknown;
        areFirst = areFirst && isNormal(std::span(words).subspan(kPlace, kNormal));
        areLast = areLast && isNormal(std::span(words).last(kNormal));
    }
    return areFirst ? NcOrder::NormalsFirst : areLast ? NcOrder::ColoursFirst : NcOrder::Unknown;
}

/// With normals before colours, of which Assimp knows by another word.
std::optional<std::string> ncForAssimp(std::string_view off, OffLines lines) {
    const NcOrder order = ncOrderOf(lines);
    if (order == NcOrder::Unknown)
        return std::nullopt;
    MendedText mended(off);
    const auto positionOf = [off](std::string_view part) {
        return static_cast<std::size_t>(part.data() - off.data());
    };
    mended.replace(positionOf(lines.word()), lines.word().size(), "CNOFF");
    std::string_view line;
    for (std::uint64_t i = 0;
         order == NcOrder::ColoursFirst && i < lines.vertices() && !(line = lines.next()).empty();
         ++i) {
        const std::vector<std::string_view> words = wordsOf(line);
        const auto normal = std::span(words).last(kNormal);
        const auto colour = std::span(words).subspan(kPlace, words.size() - kPlace - kNormal);
        const std::size_t begin = positionOf(words[kPlace]);
        mended.replace(begin, positionOf(words.back()) + words.back().size() - begin,
                       fmt::format("{} {}", fmt::join(normal, " "), fmt::join(colour, " ")));
    }
    return mended.finish();
}

}  // namespace

std::optional<std::string> offForAssimp(std::string_view off) {
    constexpr std::size_t kPlaceAndThreeColours = 6;
    OffLines lines(off);
    const OffKind kind(lines.word());
    if (!lines.isRead() || kind.isOther)
        return std::nullopt;
    if (kind.isNc)
        return ncForAssimp(off, lines);
    MendedText mended(off);
    const auto positionOf = [off](const char* at) {
        return static_cast<std::size_t>(at - off.data());
    };
    if (const std::string word = kind.word(); word != lines.word())
        mended.replace(positionOf(lines.word().data()), lines.word().size(), word);
    const std::size_t lacking = kPlaceAndThreeColours + (kind.hasPlaces ? 2 : 0);
    const std::uint64_t vertices = kind.hasColours && !kind.hasNormals ? lines.vertices() : 0;
    for (std::uint64_t i = 0; i < vertices; ++i) {
        std::string_view line = lines.next();
        if (line.empty())
            break;
        if (countWords(line) != lacking)
            continue;
        for (std::size_t word = 0; word < kPlaceAndThreeColours; ++word) takeWord(line);
        mended.replace(positionOf(line.data()), 0, " 1");
    }
    return mended.finish();
}

std::vector<std::string> offCaveats(std::string_view off) {
    const std::optional<std::string> mended = offForAssimp(off);
    OffLines lines(mended ? std::string_view(*mended) : off);
    if (!lines.isRead())
        return {};
    const OffKind kind(lines.word());
    const bool hasNormalsBeforeColours =
        kind.hasColours && kind.hasNormals && !kind.hasPlaces && !kind.isOther;
    std::uint64_t faces = 0, coloured = 0, large = 0, more = 0, notOpaque = 0;
    std::string_view line;
    for (std::uint64_t i = 0; i < lines.vertices() && !(line = lines.next()).empty(); ++i)
        notOpaque += hasNormalsBeforeColours && hasOpacity(line) ? 1 : 0;
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
            fmt::format("left out the opacity of {} vertices, which have normals, too: for "
                        "see-through surfaces export it as glTF",
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
