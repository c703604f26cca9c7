// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/config/attribute_table.h"
#include "coordinator/config/eqc_writer.h"

/// Values as the statements that they are read from. What has its usual value is left out.
namespace eyrie::config {

class StatementList {
public:
    void text(std::string_view keyword, const std::string& value) {
        if (!value.empty())
            add(plain(keyword, {Scalar::Kind::Text, value}));
    }
    void word(std::string_view keyword, std::string_view value) {
        add(plain(keyword, {Scalar::Kind::Word, std::string(value)}));
    }
    template <typename T>
    void number(std::string_view keyword, const T& value, const T& usual) {
        if (value != usual)
            add(plain(keyword, numberScalar(static_cast<double>(value))));
    }
    template <typename T>
    void number(std::string_view keyword, const std::optional<T>& value) {
        if (value)
            add(plain(keyword, numberScalar(static_cast<double>(*value))));
    }
    void numbers(std::string_view keyword, std::initializer_list<double> values) {
        Statement& list = add({std::string(keyword)});
        list.form = Statement::Form::List;
        for (const double value : values) list.values.push_back(numberScalar(value));
    }
    void pair(std::string_view keyword, const fabric::Vec2& value) {
        numbers(keyword, {value.x, value.y});
    }
    void vector(std::string_view keyword, const fabric::Vec3& value) {
        numbers(keyword, {value.x, value.y, value.z});
    }
    void viewport(std::string_view keyword, const Viewport& value) {
        numbers(keyword, {value.x, value.y, value.width, value.height});
    }
    /// The words whose flag is set.
    void flags(std::string_view keyword,
               std::initializer_list<std::pair<std::string_view, bool>> flags) {
        Statement& list = add({std::string(keyword)});
        list.form = Statement::Form::List;
        for (const auto& [word, isSet] : flags)
            if (isSet)
                list.values.push_back({Scalar::Kind::Word, std::string(word)});
    }
    void eyes(std::string_view keyword, const Eyes& eyes) {
        flags(keyword, {{"CYCLOP", eyes.cyclop}, {"LEFT", eyes.left}, {"RIGHT", eyes.right}});
    }
    void block(std::string_view keyword, StatementList inner) {
        within(Statement::Form::Block, keyword, std::move(inner));
    }
    void reference(std::string_view keyword, StatementList inner) {
        within(Statement::Form::Reference, keyword, std::move(inner));
    }
    void attributes(const Attributes& attributes) {
        for (const Attribute& attribute : attributes) add(statementOf(attribute));
    }
    void attributes(std::string_view keyword, const Attributes& attributes) {
        StatementList inner;
        inner.attributes(attributes);
        if (!attributes.empty())
            block(keyword, std::move(inner));
    }

    std::vector<Statement> take() { return std::move(statements_); }

private:
    Statement& add(Statement statement) { return statements_.emplace_back(std::move(statement)); }
    void within(Statement::Form form, std::string_view keyword, StatementList inner) {
        Statement& outer = add({std::string(keyword)});
        outer.form = form;
        outer.statements = inner.take();
    }

    std::vector<Statement> statements_;
};

/// The sections that section_readers.h reads.
void writeConnection(const Connection& connection, StatementList& list);
void writeNode(const Node& node, StatementList& list);
void writeObserver(const Observer& observer, StatementList& list);
void writeLayout(const Configuration& all, const Layout& layout, StatementList& list);
void writeCanvas(const Configuration& all, const Canvas& canvas, StatementList& list);
void writeCompound(const Configuration& all, const Compound& compound, StatementList& list);
void writeEqualizer(const Equalizer& equalizer, StatementList& list);
std::string_view keywordOf(EqualizerKind kind);  ///< load_equalizer

void writeSurface(const Surface& surface, StatementList& list);
void writeSwapBarrier(const std::optional<SwapBarrier>& barrier, StatementList& list);
void writeChannel(const Configuration& all, const ChannelIndex& index, StatementList& list);

/// By name where the first of that name is meant, else by position.
template <typename T>
void writeReference(std::string_view keyword, const std::vector<T>& named, std::size_t index,
                    StatementList& list) {
    const std::string& name = named[index].name;
    std::size_t first = 0;
    while (named[first].name != name) ++first;
    if (first == index && !name.empty())
        list.text(keyword, name);
    else
        list.number(keyword, std::optional(index));
}

}  // namespace eyrie::config
