// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/config/findings.h"

/// The text of Equalizer's configuration files (.eqc, versions 1.0 to 1.2), as statements without
/// meaning: `keyword value`, `keyword [ values ]`, `keyword { statements }`, `keyword ( … )`.
/// Comments run from # or // to the line's end.
namespace eyrie::config {

/// One word of a value.
struct Scalar {
    enum class Kind { Word, Text, Character, Integer, Real };
    Kind kind = Kind::Word;
    std::string text;   ///< as written, without quotes
    double number = 0;  ///< of Integer and Real
    Place place = {};

    /// Finite, as all numbers of a configuration are.
    bool isNumber() const {
        return (kind == Kind::Integer || kind == Kind::Real) && std::isfinite(number);
    }
    bool isWord(std::string_view word) const { return kind == Kind::Word && text == word; }
};

struct Statement {
    enum class Form {
        Missing,    ///< a keyword alone
        Plain,      ///< `values`, mostly one
        List,       ///< [ values ]
        Block,      ///< { statements }
        Reference,  ///< ( statements )
    };
    std::string keyword;
    Place place = {};
    Form form = Form::Missing;
    std::vector<Scalar> values = {};
    std::vector<Statement> statements = {};
};

struct EqcText {
    std::string version = {};  ///< "1.2" of "#Equalizer 1.2 ascii"; empty without such a line
    std::vector<Statement> statements = {};
    Place versionPlace = {};
};

/// Blocks within blocks, statements, and longest text, bytes, that are read, of any form.
inline constexpr std::size_t kMostNesting = 40;
inline constexpr std::size_t kMostStatements = 200'000;
inline constexpr std::size_t kLongestText = std::size_t{4} << 20;

/// All statements that can be told apart; what cannot is among `findings`, with its place. Never
/// fails otherwise, whatever the bytes.
EqcText parseEqc(std::string_view text, Findings& findings);

}  // namespace eyrie::config
