// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/value_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "fabric/near_name.h"
#include "fabric/utf8.h"

namespace eyrie::config {
namespace {

std::string written(const Scalar& value) {
    switch (value.kind) {
        case Scalar::Kind::Text:
            return fmt::format("\"{}\"", value.text);
        case Scalar::Kind::Character:
            return fmt::format("'{}'", value.text);
        default:
            return value.text;
    }
}

/// In each form of a configuration: .eqc has no way to write quotes, JSON none for other bytes.
bool isWritable(std::string_view text) {
    if (text.find_first_of(std::string_view("\"\n\r\0", 4)) != std::string_view::npos)
        return false;
    while (!text.empty()) {
        const std::size_t length = fabric::utf8Length(text);
        if (length == 0)
            return false;
        text.remove_prefix(length);
    }
    return true;
}

/// What stands after the keyword, shortened.
std::string written(const Statement& statement) {
    if (statement.form == Statement::Form::Missing)
        return "nothing";
    if (statement.form == Statement::Form::Block)
        return "{ … }";
    if (statement.form == Statement::Form::Reference)
        return "( … )";
    std::string text = statement.form == Statement::Form::List ? "[ " : "";
    for (const Scalar& value : statement.values) {
        if (text.size() > 60)
            return text + "…";
        text += written(value) + " ";
    }
    return statement.form == Statement::Form::List ? text + "]" : text.substr(0, text.size() - 1);
}

}  // namespace

void ValueReader::block(const Statement& block, std::string_view what,
                        std::initializer_list<Entry> entries) {
    if (block.form != Statement::Form::Block)
        return expected(block, "a block { }");
    std::map<std::string_view, std::string_view> values;  // who set each
    for (const Statement& statement : block.statements) {
        const auto entry = std::ranges::find(entries, statement.keyword, &Entry::keyword);
        const bool isValue =
            statement.form == Statement::Form::Plain || statement.form == Statement::Form::List;
        if (entry != entries.end() && !entry->mayRepeat && (isValue || !entry->alias.empty())) {
            const auto [before, isNew] = values.try_emplace(
                entry->alias.empty() ? entry->keyword : entry->alias, entry->keyword);
            if (!isNew)
                givenAgain(statement, std::exchange(before->second, entry->keyword));
        }
        if (entry != entries.end())
            entry->read(statement);
        else if (!statement.keyword.empty())
            meansNothing(statement, what, entries);
    }
}

void ValueReader::meansNothing(const Statement& statement, std::string_view what,
                               std::initializer_list<Entry> entries) {
    std::vector<std::string> keywords;
    for (const Entry& each : entries) keywords.emplace_back(each.keyword);
    findings_.warning(statement.place,
                      fmt::format("'{}' means nothing in {} and is left out{}", statement.keyword,
                                  what, fabric::didYouMean(statement.keyword, keywords)));
}

const Scalar* ValueReader::single(const Statement& statement) {
    return statement.form == Statement::Form::Plain && statement.values.size() == 1
               ? &statement.values.front()
               : nullptr;
}

void ValueReader::expected(const Statement& statement, std::string_view what) {
    if (statement.form == Statement::Form::Missing)
        return;  // which was said when the text was read
    findings_.error(statement.place, fmt::format("'{}' is {}; expected {}", statement.keyword,
                                                 written(statement), what));
}

void ValueReader::hasNoEffect(const Statement& statement, std::string_view why,
                              Finding::Kind kind) {
    std::string message = fmt::format("'{}' has no effect here: {}", statement.keyword, why);
    if (kind == Finding::Kind::OnScreen)
        findings_.onScreen(statement.place, std::move(message));
    else
        findings_.note(statement.place, std::move(message));
}

void ValueReader::givenAgain(const Statement& statement, std::string_view before) {
    findings_.warning(
        statement.place,
        fmt::format("'{}' is given again{}: what it was before does not count", statement.keyword,
                    before == statement.keyword ? "" : fmt::format(" (before as '{}')", before)));
}

void ValueReader::text(const Statement& statement, std::string& target) {
    const Scalar* const value = single(statement);
    if (value == nullptr || value->kind != Scalar::Kind::Text)
        return expected(statement, "a text in quotes");
    if (!isWritable(value->text))
        return expected(statement, "UTF-8 without quotes or ends of lines");
    target = value->text;
}

void ValueReader::wholeNumber(const Statement& statement, std::int64_t low, std::int64_t high,
                              std::int64_t& target) {
    const Scalar* const value = single(statement);
    if (value == nullptr || value->kind != Scalar::Kind::Integer ||
        !(value->number >= static_cast<double>(low)) ||
        !(value->number <= static_cast<double>(high)))
        return expected(statement, fmt::format("a whole number from {} to {}", low, high));
    target = static_cast<std::int64_t>(value->number);
}

void ValueReader::number(const Statement& statement, double& target) {
    const Scalar* const value = single(statement);
    if (value == nullptr || !value->isNumber())
        return expected(statement, "a number");
    target = value->number;
}

bool ValueReader::isList(const Statement& statement, std::size_t count, bool isWhole) const {
    return statement.form == Statement::Form::List && statement.values.size() == count &&
           std::ranges::all_of(statement.values, [isWhole](const Scalar& value) {
               return value.isNumber() && (!isWhole || value.kind == Scalar::Kind::Integer);
           });
}

void ValueReader::numbers(const Statement& statement, std::initializer_list<double*> targets) {
    if (!isList(statement, targets.size(), false))
        return expected(statement, fmt::format("{} numbers in [ ]", targets.size()));
    auto value = statement.values.begin();
    for (double* const target : targets) *target = (value++)->number;
}

void ValueReader::wholeNumbers(const Statement& statement,
                               std::initializer_list<std::int64_t*> targets) {
    constexpr std::int64_t kMost = 1'000'000'000;
    if (!isList(statement, targets.size(), true) ||
        std::ranges::any_of(statement.values, [](const Scalar& value) {
            return value.number < 0 || value.number > static_cast<double>(kMost);
        }))
        return expected(statement,
                        fmt::format("{} whole numbers from 0 to {} in [ ]", targets.size(), kMost));
    auto value = statement.values.begin();
    for (std::int64_t* const target : targets)
        *target = static_cast<std::int64_t>((value++)->number);
}

void ValueReader::viewport(const Statement& statement, Viewport& target) {
    Viewport read;
    if (!isList(statement, 4, false))
        return expected(statement, "[ x y width height ]");
    numbers(statement, {&read.x, &read.y, &read.width, &read.height});
    constexpr double kMostPixels = 1 << 20;
    if (!(read.width > 0 && read.height > 0 && read.width <= kMostPixels &&
          read.height <= kMostPixels && std::abs(read.x) <= kMostPixels &&
          std::abs(read.y) <= kMostPixels))
        return expected(statement, "a width and a height above 0");
    target = read;
}

void ValueReader::fraction(const Statement& statement, Viewport& target) {
    Viewport read = target;
    const std::size_t errors = findings_.errors();
    viewport(statement, read);
    if (findings_.errors() > errors)
        return;
    constexpr double kSlack = 1e-3;  // thirds are written as .3333 and .6667
    if (read.x < 0 || read.y < 0 || read.x + read.width > 1 + kSlack ||
        read.y + read.height > 1 + kSlack)
        return expected(statement, "a part of [ 0 0 1 1 ]");
    target = read;
}

void ValueReader::flags(const Statement& statement,
                        std::initializer_list<std::pair<std::string_view, bool*>> flags) {
    if (statement.form != Statement::Form::List)
        return expected(statement, "words in [ ]");
    std::vector<std::string_view> words;
    for (const auto& [word, flag] : flags) {
        words.push_back(word);
        *flag = false;
    }
    for (const Scalar& value : statement.values) {
        const auto named = std::ranges::find_if(
            flags, [&value](const auto& each) { return value.isWord(each.first); });
        if (named == flags.end())
            findings_.error(value.place, fmt::format("'{}' in {}; expected {}", written(value),
                                                     statement.keyword, wordsOf(words)));
        else
            *named->second = true;
    }
}

std::string ValueReader::wordsOf(const std::vector<std::string_view>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : i + 1 < words.size() ? ", " : " or ", words[i]);
    return text;
}

void ValueReader::unknown(const Scalar& value, std::string_view what, std::size_t count) {
    findings_.error(
        value.place,
        value.kind == Scalar::Kind::Text
            ? fmt::format("no {} named {} is defined before this", what, written(value))
            : fmt::format("no {} {}: {} are defined before this", what, value.text, count));
}

}  // namespace eyrie::config
