// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "renderer/import/byte_colours.h"
#include "renderer/import/mended_text.h"
#include "renderer/import/obj_textures.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// Whether a line without blanks at its begin has numbers after its keyword, not names, which may
/// have any marks.
bool hasNumbers(std::string_view line) {
    constexpr std::array<std::string_view, 8> kKeywords = {"v", "vn", "vt", "vp",
                                                           "f", "fo", "l",  "p"};
    return std::ranges::count(kKeywords, line.substr(0, line.find_first_of(kBlank))) > 0;
}

/// Of its place, and of what more is told of it there.
bool isVertex(std::string_view line) { return line.substr(0, line.find_first_of(kBlank)) == "v"; }

/// What begins otherwise goes on with the line before it, or says nothing.
bool hasKeyword(std::string_view line) { return !line.empty() && line[0] >= 'a' && line[0] <= 'z'; }

/// Of a part of the file at `first`.
void mendPoints(std::string_view numbers, std::size_t first, MendedText& mended) {
    for (std::size_t at = numbers.find('.'); at != std::string_view::npos;
         at = numbers.find('.', at + 1))
        if (at > 0 && kBlank.find(numbers[at - 1]) != std::string_view::npos)
            mended.replace(first + at, 0, "0");
}

/// Where a comment begins, or backslashes right before it: what is left of the line does not go on
/// with the next one.
std::size_t endOfNumbers(std::string_view line) {
    const std::size_t comment = line.find('#');
    return comment == line.npos ? line.size() : line.substr(0, comment).find_last_not_of('\\') + 1;
}

/// The numbers of a vertex; none of another line. Three are its place, and a fourth its weight,
/// which polygons have no use for. Of six the last three are its colour, and of seven either those,
/// behind a weight, or the three before an opacity. What others mean is written nowhere.
class VertexNumbers {
public:
    explicit VertexNumbers(std::string_view line) : line_(line.substr(0, endOfNumbers(line))) {
        if (!isVertex(line_))
            return;
        const std::size_t keyword = std::min(line_.find_first_of(kBlank), line_.size());
        for (std::size_t at = line_.find_first_not_of(kBlank, keyword);
             at < line_.size() && count_ < numbers_.size(); ++count_) {
            const std::size_t end = std::min(line_.find_first_of(kBlank, at), line_.size());
            numbers_[count_] = line_.substr(at, end - at);
            at = line_.find_first_not_of(kBlank, end);
        }
    }

    bool haveColour() const { return count_ == 6 || areSeven(); }
    bool haveNoColour() const { return count_ >= 3 && !haveColour(); }
    bool areSeven() const { return count_ == 7; }
    bool areOfNoKind() const { return count_ == 5 || count_ == numbers_.size(); }

    double value(std::size_t i) const {
        double number = 0;
        std::from_chars(numbers_[i].data(), numbers_[i].data() + numbers_[i].size(), number);
        return number;
    }
    double mostBehindPlace() const {
        double most = 0;
        for (std::size_t i = 3; i < count_; ++i) most = std::max(most, value(i));
        return most;
    }

    /// The part of the line that is neither place nor colour.
    std::string_view unread(bool haveWeights) const {
        if (count_ <= 3 || count_ == 6)
            return line_.substr(line_.size());
        const std::size_t first = areSeven() && !haveWeights ? 6 : 3;
        const auto at = static_cast<std::size_t>(numbers_[first].data() - line_.data());
        return line_.substr(at, areSeven() ? numbers_[first].size() : line_.npos);
    }

private:
    std::string_view line_;
    std::array<std::string_view, 8> numbers_;  // eight are eight or more
    std::size_t count_ = 0;
};

/// Calls `use` with each line and where it begins.
template <typename Use>
void forEachLine(std::string_view obj, std::size_t at, const Use& use) {
    while (at < obj.size()) {
        const std::size_t end = std::min(obj.find_first_of("\r\n", at), obj.size());
        use(obj.substr(at, end - at), at);
        at = end + 1;
    }
}

std::string_view withoutIndent(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    return line;
}

/// What the vertices of a file are like.
struct VertexKinds {
    std::string_view white;    ///< for those without a colour, where others have one
    bool haveWeights = false;  ///< those of seven numbers; others' last is an opacity
    std::uint64_t ofNoKind = 0;
    std::uint64_t notOpaque = 0;
};

VertexKinds kindsOf(std::string_view obj, std::size_t at) {
    VertexKinds kinds;
    bool someHave = false, someLack = false, fourthsAreOne = true, lastsAreOne = true;
    double most = 0;
    forEachLine(obj, at, [&](std::string_view line, std::size_t) {
        const VertexNumbers numbers(withoutIndent(line));
        someHave = someHave || numbers.haveColour();
        someLack = someLack || numbers.haveNoColour();
        kinds.ofNoKind += numbers.areOfNoKind() ? 1 : 0;
        if (numbers.haveColour())
            most = std::max(most, numbers.mostBehindPlace());
        if (!numbers.areSeven())
            return;
        fourthsAreOne = fourthsAreOne && numbers.value(3) == 1;
        lastsAreOne = lastsAreOne && numbers.value(6) == 1;
        kinds.notOpaque += numbers.value(6) != 1 && numbers.value(6) != 255 ? 1 : 0;
    });
    kinds.haveWeights = fourthsAreOne && !lastsAreOne;
    if (kinds.haveWeights)
        kinds.notOpaque = 0;
    if (someHave && someLack)
        kinds.white = most > kMostOfFractions ? " 255 255 255" : " 1 1 1";
    return kinds;
}

void mendNumbers(std::string_view line, std::size_t first, const VertexKinds& kinds,
                 MendedText& mended) {
    const VertexNumbers vertex(line);
    const std::size_t end = endOfNumbers(line);
    const std::string_view unread = vertex.unread(kinds.haveWeights);
    const auto from = static_cast<std::size_t>(unread.data() - line.data());
    const std::size_t to = from + unread.size();
    mendPoints(line.substr(0, from), first, mended);
    if (!unread.empty())
        mended.replace(first + from, unread.size(), "");
    mendPoints(line.substr(to, end - to), first + to, mended);
    const std::string_view more = vertex.haveNoColour() ? kinds.white : std::string_view();
    if (end < line.size() || !more.empty())
        mended.replace(first + end, line.size() - end, more);
}

/// Of several files on a line Assimp reads none.
void mendLibraries(std::string_view line, std::size_t first, MendedText& mended) {
    constexpr std::string_view kLibrary = "mtllib";
    if (!line.starts_with(kLibrary))
        return;
    const std::vector<std::string> names = namesOfLibraries(line.substr(kLibrary.size()));
    if (names.size() > 1)
        mended.replace(
            first, line.size(),
            fmt::format("{} {}", kLibrary, fmt::join(names, fmt::format("\n{} ", kLibrary))));
}

void mendLine(std::string_view source, std::size_t first, const VertexKinds& kinds,
              MendedText& mended) {
    const std::string_view line = withoutIndent(source);
    const std::size_t indent = source.size() - line.size();
    if (indent > 0 && hasKeyword(line))
        mended.replace(first, indent, "");
    mendLibraries(line, first + indent, mended);
    if (hasNumbers(line))
        mendNumbers(line, first + indent, kinds, mended);
}

std::size_t endOfByteOrderMarks(std::string_view obj) {
    std::size_t at = 0;
    while (obj.substr(at).starts_with(kByteOrderMark)) at += kByteOrderMark.size();
    return at;
}

/// With vertices on one line that go on behind a backslash, and without that mark at the end of
/// comments, which Assimp lets go on, too; nothing where there is neither.
std::optional<std::string> withWholeLines(std::string_view obj) {
    std::optional<std::string> whole;
    bool goesOn = false, isOfVertex = false, isComment = false;
    forEachLine(obj, endOfByteOrderMarks(obj), [&](std::string_view part, std::size_t first) {
        if (first > 0 && obj.substr(first - 1).starts_with("\r\n"))
            return;  // the end of the part before
        if (!goesOn)
            isOfVertex = isVertex(withoutIndent(part));
        isComment = (goesOn && isComment) || part.find('#') != part.npos;
        goesOn = false;
        const std::string_view behind = obj.substr(first + part.size());
        const std::size_t end = behind.starts_with("\r\n") ? 2 : behind.starts_with('\n') ? 1 : 0;
        if (!part.ends_with('\\') || end == 0 || (!isComment && !isOfVertex))
            return;
        if (!whole)
            whole = std::string(obj);
        goesOn = !isComment;
        const std::size_t length = goesOn ? 1 + end : 1;
        whole->replace(first + part.size() - 1, length, length, ' ');
    });
    return whole;
}

std::optional<std::string> mendedLines(std::string_view obj) {
    MendedText mended(obj);
    const std::size_t at = endOfByteOrderMarks(obj);
    if (at > 0)
        mended.replace(0, at, "");
    const VertexKinds kinds = kindsOf(obj, at);
    forEachLine(obj, at, [&](std::string_view line, std::size_t first) {
        mendLine(line, first, kinds, mended);
    });
    return mended.finish();
}

}  // namespace

std::optional<std::string> objForAssimp(std::string_view obj) {
    std::optional<std::string> whole = withWholeLines(obj);
    if (!whole)
        return mendedLines(obj);
    std::optional<std::string> mended = mendedLines(*whole);
    return mended ? mended : whole;
}

std::vector<std::string> objVertexCaveats(std::string_view text) {
    const std::optional<std::string> whole = withWholeLines(text);
    const std::string_view obj = whole ? std::string_view(*whole) : text;
    const VertexKinds kinds = kindsOf(obj, endOfByteOrderMarks(obj));
    std::vector<std::string> caveats;
    if (kinds.ofNoKind > 0)
        caveats.push_back(fmt::format(
            "left out all but the places of {} vertices that have five numbers, or more "
            "than seven: give their colours as three numbers behind the places",
            kinds.ofNoKind));
    if (kinds.notOpaque > 0)
        caveats.push_back(
            fmt::format("left out the opacity of {} vertices, which is taken to be the seventh of "
                        "their numbers: give it to materials",
                        kinds.notOpaque));
    return caveats;
}

}  // namespace eyrie::import
