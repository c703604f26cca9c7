// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/eqc_grammar.h"

/// Statements' values as what they mean. Each function sets its target, or says among the findings
/// what is there and what was expected, and leaves it as it was.
namespace eyrie::config {

/// What to do with the statements of one keyword.
struct Entry {
    std::string_view keyword;
    std::function<void(const Statement&)> read;
    bool mayRepeat = false;  ///< a value that stands for one of several, as blocks do
    /// A keyword that sets the same, as a `projection` does what a `wall` does; its own of blocks
    /// of which the last one counts.
    std::string_view alias = {};
};

class ValueReader {
public:
    explicit ValueReader(Findings& findings) : findings_(findings) {}

    /// Hands each statement of a block to its keyword's entry; others are warned of, and values
    /// that are given twice, as those blocks that set one. `what` names the block.
    void block(const Statement& block, std::string_view what, std::initializer_list<Entry> entries);

    void text(const Statement& statement, std::string& target);
    void wholeNumber(const Statement& statement, std::int64_t low, std::int64_t high,
                     std::int64_t& target);
    /// Finite, as all numbers.
    void number(const Statement& statement, double& target);
    /// In [ ].
    void numbers(const Statement& statement, std::initializer_list<double*> targets);
    void wholeNumbers(const Statement& statement, std::initializer_list<std::int64_t*> targets);
    void vector(const Statement& statement, fabric::Vec3& target) {
        numbers(statement, {&target.x, &target.y, &target.z});
    }
    void pair(const Statement& statement, fabric::Vec2& target) {
        numbers(statement, {&target.x, &target.y});
    }
    /// [ x y width height ], of positive width and height.
    void viewport(const Statement& statement, Viewport& target);
    /// In fractions of what it is a part of.
    void fraction(const Statement& statement, Viewport& target);
    /// Any of these words in [ ], each of which sets its flag; those not there unset theirs.
    void flags(const Statement& statement,
               std::initializer_list<std::pair<std::string_view, bool*>> flags);

    /// Has `read` fill a value, and sets `target` to it where nothing was wrong.
    template <typename T, typename Read>
    void optional(std::optional<T>& target, const Read& read) {
        T value{};
        const std::size_t errors = findings_.errors();
        read(value);
        if (findings_.errors() == errors)
            target = value;
    }

    /// One of these words.
    template <typename T>
    void choice(const Statement& statement,
                std::initializer_list<std::pair<std::string_view, T>> choices, T& target) {
        const Scalar* const value = single(statement);
        for (const auto& [word, meaning] : choices)
            if (value != nullptr && value->isWord(word)) {
                target = meaning;
                return;
            }
        std::vector<std::string_view> words;
        for (const auto& each : choices) words.push_back(each.first);
        expected(statement, wordsOf(words));
    }

    /// The position of the one of `named` that a name or an index means; nothing where there is
    /// none, which is an error.
    template <typename T>
    std::optional<std::size_t> reference(const Statement& statement, const std::vector<T>& named,
                                         std::string_view what) {
        const Scalar* const value = single(statement);
        if (value == nullptr ||
            (value->kind != Scalar::Kind::Text && value->kind != Scalar::Kind::Integer)) {
            expected(statement, "a name in quotes or a number from 0 on");
            return std::nullopt;
        }
        for (std::size_t i = 0; i < named.size(); ++i)
            if (value->kind == Scalar::Kind::Text ? named[i].name == value->text
                                                  : static_cast<double>(i) == value->number)
                return i;
        unknown(*value, what, named.size());
        return std::nullopt;
    }

    /// The statement's one value, or null.
    static const Scalar* single(const Statement& statement);
    void expected(const Statement& statement, std::string_view what);
    /// Of what is accepted; `why` goes on a sentence.
    void hasNoEffect(const Statement& statement, std::string_view why,
                     Finding::Kind kind = Finding::Kind::Note);
    /// Where a value was given before, by this keyword or another.
    void givenAgain(const Statement& statement, std::string_view before);
    Findings& findings() { return findings_; }

private:
    void meansNothing(const Statement& statement, std::string_view what,
                      std::initializer_list<Entry> entries);
    static std::string wordsOf(const std::vector<std::string_view>& words);
    void unknown(const Scalar& value, std::string_view what, std::size_t count);
    bool isList(const Statement& statement, std::size_t count, bool isWhole) const;

    Findings& findings_;
};

}  // namespace eyrie::config
