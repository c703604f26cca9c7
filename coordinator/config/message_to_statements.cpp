// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/message_to_statements.h"

#include <fmt/format.h>

#include "coordinator/config/attribute_table.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/message_fields.h"

namespace eyrie::config {
namespace {

using google::protobuf::Message;
using Form = Statement::Form;

Statement statement(const std::string& keyword, Form form, const std::string& path) {
    Statement made{keyword, {0, 0, path}};
    made.form = form;
    return made;
}

/// Of a field that is no message; nothing where it is unset.
Scalar scalar(const Message& message, const FieldDescriptor& field) {
    const google::protobuf::Reflection& reflection = *message.GetReflection();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_STRING:
            return {Scalar::Kind::Text, reflection.GetString(message, &field)};
        case FieldDescriptor::CPPTYPE_INT32:
            return numberScalar(reflection.GetInt32(message, &field));
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return numberScalar(reflection.GetDouble(message, &field));
        case FieldDescriptor::CPPTYPE_ENUM: {
            const int number = reflection.GetEnumValue(message, &field);
            const auto* const value = field.enum_type()->FindValueByNumber(number);
            return {Scalar::Kind::Word,
                    value == nullptr ? fmt::format("{}", number) : wordOf(*value)};
        }
        default:
            return {Scalar::Kind::Word, wordOf(field)};
    }
}

class Writer {
public:
    explicit Writer(Findings& findings) : findings_(findings) {}

    std::vector<Statement> write(const Message& message, const std::string& path,
                                 std::size_t depth) {
        std::vector<const FieldDescriptor*> fields;
        message.GetReflection()->ListFields(message, &fields);
        std::vector<Statement> made;
        for (const FieldDescriptor* const field : fields)
            addField(message, *field, path.empty() ? path : path + ".", depth, made);
        return made;
    }

private:
    void addField(const Message& message, const FieldDescriptor& field, const std::string& before,
                  std::size_t depth, std::vector<Statement>& made) {
        const google::protobuf::Reflection& reflection = *message.GetReflection();
        const std::string path = before + field.json_name();
        const bool isMessage = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
        if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL)
            return;  // is_application: the node's keyword says it
        if (isMessage && isAttribute(field))
            return addAttributes(message, field, path, made);
        if (!field.is_repeated())
            return isMessage ? add(reflection.GetMessage(message, &field), field, path, depth, made)
                             : addScalar(message, field, path, made);
        const int count = reflection.FieldSize(message, &field);
        if (!isMessage)
            return addList(message, field, count, path, made);
        for (int i = 0; i < count; ++i)
            add(reflection.GetRepeatedMessage(message, &field, i), field,
                fmt::format("{}[{}]", path, i), depth, made);
    }

    void add(const Message& message, const FieldDescriptor& field, const std::string& path,
             std::size_t depth, std::vector<Statement>& made) {
        if (isTooMuch(path, depth))
            return;
        const Descriptor& type = *message.GetDescriptor();
        const std::string keyword = keywordOf(field);
        if (isFlags(type))
            return made.push_back(flags(message, keyword, path));
        if (isReference(type))
            return made.push_back(reference(message, keyword, path, depth));
        std::vector<Statement> inner = write(message, path, depth + 1);
        if (keyword.empty()) {
            if (inner.empty())
                noValue(path);
            for (Statement& each : inner) made.push_back(std::move(each));
            return;
        }
        const auto* const node = dynamic_cast<const v1::Node*>(&message);
        made.push_back(statement(node != nullptr && node->is_application() ? "appNode" : keyword,
                                 Form::Block, path));
        made.back().statements = std::move(inner);
    }

    static Statement flags(const Message& message, const std::string& keyword,
                           const std::string& path) {
        Statement made = statement(keyword, Form::List, path);
        const Descriptor& type = *message.GetDescriptor();
        for (int i = 0; i < type.field_count(); ++i)
            if (message.GetReflection()->GetBool(message, type.field(i)))
                made.values.push_back({Scalar::Kind::Word, wordOf(*type.field(i)), 0, made.place});
        return made;
    }

    Statement reference(const Message& message, const std::string& keyword, const std::string& path,
                        std::size_t depth) {
        Statement made = statement(keyword, Form::Missing, path);
        const auto* const field = message.GetReflection()->GetOneofFieldDescriptor(
            message, message.GetDescriptor()->FindOneofByName("to"));
        if (field == nullptr) {
            noValue(path);
            return made;
        }
        if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
            made.form = Form::Reference;
            made.statements =
                write(message.GetReflection()->GetMessage(message, field), path, depth + 1);
            return made;
        }
        made.form = Form::Plain;
        made.values.push_back(scalar(message, *field));
        made.values.back().place = made.place;
        return made;
    }

    static void addScalar(const Message& message, const FieldDescriptor& field,
                          const std::string& path, std::vector<Statement>& made) {
        made.push_back(statement(keywordOf(field), Form::Plain, path));
        made.back().values.push_back(scalar(message, field));
        made.back().values.back().place = made.back().place;
    }

    static void addList(const Message& message, const FieldDescriptor& field, int count,
                        const std::string& path, std::vector<Statement>& made) {
        const google::protobuf::Reflection& reflection = *message.GetReflection();
        made.push_back(statement(keywordOf(field), Form::List, path));
        for (int i = 0; i < count; ++i)
            made.back().values.push_back(
                numberScalar(field.cpp_type() == FieldDescriptor::CPPTYPE_INT32
                                 ? reflection.GetRepeatedInt32(message, &field, i)
                                 : reflection.GetRepeatedDouble(message, &field, i)));
    }

    void addAttributes(const Message& message, const FieldDescriptor& field,
                       const std::string& path, std::vector<Statement>& made) {
        std::vector<Statement> inner;
        const int count = message.GetReflection()->FieldSize(message, &field);
        for (int i = 0; i < count; ++i) {
            const std::string at = fmt::format("{}[{}]", path, i);
            if (isTooMuch(at, 0))
                break;
            const auto& each = dynamic_cast<const v1::Attribute&>(
                message.GetReflection()->GetRepeatedMessage(message, &field, i));
            if (each.value_case() == v1::Attribute::VALUE_NOT_SET)
                noValue(at);
            inner.push_back(attribute(each));
            inner.back().place.field = at;
        }
        if (keywordOf(field).empty()) {
            for (Statement& each : inner) made.push_back(std::move(each));
            return;
        }
        made.push_back(statement(keywordOf(field), Form::Block, path));
        made.back().statements = std::move(inner);
    }

    static Statement attribute(const v1::Attribute& message) {
        Attribute made{message.name(), {}};
        if (message.has_words())
            made.value =
                Attribute::Words{{message.words().words().begin(), message.words().words().end()}};
        else if (message.has_number())
            made.value = message.number();
        else if (message.has_text())
            made.value = message.text();
        else
            return {message.name()};
        return statementOf(made);
    }

    void noValue(const std::string& path) { findings_.error({0, 0, path}, "it has no value"); }

    bool isTooMuch(const std::string& path, std::size_t depth) {
        if (depth >= kMostNesting)
            findings_.error({0, 0, path},
                            fmt::format("more than {} blocks within each other", kMostNesting));
        else if (++count_ == kMostStatements)
            findings_.error({0, 0, path}, fmt::format("more than {} statements", kMostStatements));
        return depth >= kMostNesting || count_ >= kMostStatements;
    }

    Findings& findings_;
    std::size_t count_ = 0;
};

}  // namespace

std::vector<Statement> toStatements(const Message& part, Findings& findings) {
    return Writer(findings).write(part, "", 0);
}

EqcText toStatements(const v1::Configuration& message, Findings& findings) {
    constexpr std::size_t kWithinServerAndConfig = 2;
    Statement server{"server"};
    Statement config{"config"};
    server.form = config.form = Form::Block;
    EqcText text{message.version()};
    text.versionPlace.field = "version";
    for (Statement& each : Writer(findings).write(message, "", kWithinServerAndConfig)) {
        if (each.keyword == "global")
            text.statements.push_back(std::move(each));
        else if (each.keyword == "connection")
            server.statements.push_back(std::move(each));
        else if (each.keyword != "version")
            config.statements.push_back(std::move(each));
    }
    server.statements.push_back(std::move(config));
    text.statements.push_back(std::move(server));
    return text;
}

}  // namespace eyrie::config
