// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/eqc_writer.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

using Form = Statement::Form;

class Text {
public:
    void add(const Statement& statement, std::size_t depth) {
        text_.append(4 * depth, ' ');
        text_ += statement.keyword;
        switch (statement.form) {
            case Form::Missing:
                break;
            case Form::Plain:
                addValues(statement);
                break;
            case Form::List:
                text_ += " [";
                addValues(statement);
                text_ += " ]";
                break;
            case Form::Reference:
                addReference(statement);
                break;
            case Form::Block:
                addBlock(statement, depth);
                break;
        }
        text_ += '\n';
    }

    std::string text_;

private:
    /// Of few statements without blocks; else empty.
    static std::string inOneLine(const std::vector<Statement>& statements) {
        constexpr std::size_t kMost = 60;
        Text line;
        for (const Statement& each : statements) {
            if (each.form == Form::Block || line.text_.size() > kMost)
                return {};
            line.add(each, 0);
        }
        std::ranges::replace(line.text_, '\n', ' ');
        return line.text_.size() > kMost ? "" : fmt::format(" {{ {}}}", line.text_);
    }
    void addValues(const Statement& statement) {
        for (const Scalar& value : statement.values) {
            const char* const quote = value.kind == Scalar::Kind::Text        ? "\""
                                      : value.kind == Scalar::Kind::Character ? "'"
                                                                              : "";
            text_ += fmt::format(" {}{}{}", quote, value.text, quote);
        }
    }
    void addReference(const Statement& statement) {
        text_ += " (";
        for (const Statement& each : statement.statements) {
            text_ += ' ';
            text_ += each.keyword;
            addValues(each);
        }
        text_ += " )";
    }
    void addBlock(const Statement& statement, std::size_t depth) {
        if (statement.statements.empty()) {
            text_ += " {}";
            return;
        }
        if (const std::string line = inOneLine(statement.statements); !line.empty()) {
            text_ += line;
            return;
        }
        text_ += " {\n";
        for (const Statement& each : statement.statements) add(each, depth + 1);
        text_.append(4 * depth, ' ');
        text_ += '}';
    }
};

}  // namespace

Scalar numberScalar(double value) {
    std::array<char, 1100> digits{};  // the longest: 5e-324
    const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed);
    Scalar scalar{Scalar::Kind::Integer, std::string(digits.begin(), end.ptr), value};
    if (scalar.text.find('.') != std::string::npos)
        scalar.kind = Scalar::Kind::Real;
    return scalar;
}

Statement plain(std::string_view keyword, Scalar value) {
    Statement statement{std::string(keyword)};
    statement.form = Form::Plain;
    statement.values.push_back(std::move(value));
    return statement;
}

std::string writeEqc(const Configuration& configuration) {
    const EqcText statements = statementsOf(configuration);
    Text text;
    if (!statements.version.empty())
        text.text_ = fmt::format("#Equalizer {} ascii\n\n", statements.version);
    for (const Statement& statement : statements.statements) text.add(statement, 0);
    return std::move(text.text_);
}

}  // namespace eyrie::config
