// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <span>

#include "renderer/import/byte_colours.h"
#include "renderer/import/mended_text.h"

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

/// What begins otherwise goes on with the line before it, or says nothing.
bool hasKeyword(std::string_view line) { return !line.empty() && line[0] >= 'a' && line[0] <= 'z'; }

/// Of the line that begins at `first`, and that ends with `more` then.
void mendNumbers(std::string_view line, std::size_t first, std::string_view more,
                 MendedText& mended) {
    const std::size_t comment = std::min(line.find('#'), line.size());
    const std::string_view numbers = line.substr(0, comment);
    for (std::size_t at = numbers.find('.'); at != std::string_view::npos;
         at = numbers.find('.', at + 1))
        if (at > 0 && kBlank.find(numbers[at - 1]) != std::string_view::npos)
            mended.replace(first + at, 0, "0");
    if (comment < line.size() || !more.empty())
        mended.replace(first + comment, line.size() - comment, more);
}

/// The numbers of a vertex, which are three, or six with its colour; none of another line.
class VertexNumbers {
public:
    explicit VertexNumbers(std::string_view line) {
        line = line.substr(0, line.find('#'));
        const std::size_t keyword = std::min(line.find_first_of(kBlank), line.size());
        if (line.substr(0, keyword) != "v")
            return;
        for (std::size_t at = line.find_first_not_of(kBlank, keyword);
             at < line.size() && count_ < numbers_.size(); ++count_) {
            const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
            numbers_[count_] = line.substr(at, end - at);
            at = line.find_first_not_of(kBlank, end);
        }
    }

    bool areOfAPlace() const { return count_ == 3; }
    bool haveColour() const { return count_ == 6; }
    double mostOfColour() const {
        double most = 0;
        for (const std::string_view text : std::span(numbers_).subspan(3, 3)) {
            double number = 0;
            std::from_chars(text.data(), text.data() + text.size(), number);
            most = std::max(most, number);
        }
        return most;
    }

private:
    std::array<std::string_view, 7> numbers_;
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

/// The colour of vertices that have none, where others have one; empty where that is not so.
std::string_view whiteOf(std::string_view obj, std::size_t at) {
    bool someHave = false, someLack = false;
    double most = 0;
    forEachLine(obj, at, [&](std::string_view line, std::size_t) {
        const VertexNumbers numbers(withoutIndent(line));
        someLack = someLack || numbers.areOfAPlace();
        if (!numbers.haveColour())
            return;
        someHave = true;
        most = std::max(most, numbers.mostOfColour());
    });
    if (!someHave || !someLack)
        return "";
    return most > kMostOfFractions ? " 255 255 255" : " 1 1 1";
}

void mendLine(std::string_view source, std::size_t first, std::string_view white,
              MendedText& mended) {
    const std::string_view line = withoutIndent(source);
    const std::size_t indent = source.size() - line.size();
    if (indent > 0 && hasKeyword(line))
        mended.replace(first, indent, "");
    if (hasNumbers(line))
        mendNumbers(line, first + indent,
                    VertexNumbers(line).areOfAPlace() ? white : std::string_view(), mended);
}

}  // namespace

std::optional<std::string> objForAssimp(std::string_view obj) {
    MendedText mended(obj);
    std::size_t at = 0;
    while (obj.substr(at).starts_with(kByteOrderMark)) {
        mended.replace(at, kByteOrderMark.size(), "");
        at += kByteOrderMark.size();
    }
    const std::string_view white = whiteOf(obj, at);
    forEachLine(obj, at, [&](std::string_view line, std::size_t first) {
        mendLine(line, first, white, mended);
    });
    return mended.finish();
}

}  // namespace eyrie::import
