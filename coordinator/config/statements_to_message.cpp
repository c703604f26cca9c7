// SPDX-License-Identifier: Apache-2.0
#include <cassert>

#include "coordinator/config/message_fields.h"
#include "coordinator/config/message_to_statements.h"

namespace eyrie::config {
namespace {

using google::protobuf::Message;
using Form = Statement::Form;

bool isMessage(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
}

/// Whether what stands after a keyword can be what the field holds: size is two numbers or one.
bool fits(const FieldDescriptor& field, Form form) {
    if (!isMessage(field))
        return form == (field.is_repeated() ? Form::List : Form::Plain);
    if (!isAttribute(field) && isFlags(*field.message_type()))
        return form == Form::List;
    if (!isAttribute(field) && isReference(*field.message_type()))
        return form == Form::Plain || form == Form::Reference;
    return form == Form::Block;
}

/// That of the keyword; else one without block that has it inside.
const FieldDescriptor* fieldOf(const Descriptor& type, const Statement& statement) {
    const std::string keyword = statement.keyword == "appNode" ? "node" : statement.keyword;
    for (int i = 0; i < type.field_count(); ++i)
        if (keywordOf(*type.field(i)) == keyword && fits(*type.field(i), statement.form))
            return type.field(i);
    for (int i = 0; i < type.field_count(); ++i) {
        const FieldDescriptor& field = *type.field(i);
        if (keywordOf(field).empty() &&
            (isAttribute(field) || fieldOf(*field.message_type(), statement) != nullptr))
            return &field;
    }
    return nullptr;
}

void setAttribute(const Statement& statement, v1::Attribute& attribute) {
    attribute.set_name(statement.keyword);
    const bool isWords =
        statement.form == Form::List || statement.values.front().kind == Scalar::Kind::Word;
    if (isWords) {
        attribute.mutable_words();
        for (const Scalar& value : statement.values)
            attribute.mutable_words()->add_words(value.text);
    } else if (statement.values.front().isNumber()) {
        attribute.set_number(statement.values.front().number);
    } else {
        attribute.set_text(statement.values.front().text);
    }
}

/// The value of this enumeration that has that word.
int numberOf(const google::protobuf::EnumDescriptor& type, const std::string& word) {
    for (int i = 0; i < type.value_count(); ++i)
        if (wordOf(*type.value(i)) == word)
            return type.value(i)->number();
    return 0;
}

void setScalar(const Scalar& value, const FieldDescriptor& field, Message& message) {
    const google::protobuf::Reflection& reflection = *message.GetReflection();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_STRING:
            return reflection.SetString(&message, &field, value.text);
        case FieldDescriptor::CPPTYPE_INT32:
            return reflection.SetInt32(&message, &field, static_cast<std::int32_t>(value.number));
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return reflection.SetDouble(&message, &field, value.number);
        case FieldDescriptor::CPPTYPE_BOOL:
            return reflection.SetBool(&message, &field, true);
        default:
            return reflection.SetEnumValue(&message, &field,
                                           numberOf(*field.enum_type(), value.text));
    }
}

void setList(const Statement& statement, const FieldDescriptor& field, Message& message) {
    for (const Scalar& value : statement.values)
        if (field.cpp_type() == FieldDescriptor::CPPTYPE_INT32)
            message.GetReflection()->AddInt32(&message, &field,
                                              static_cast<std::int32_t>(value.number));
        else
            message.GetReflection()->AddDouble(&message, &field, value.number);
}

void setFlags(const Statement& statement, Message& message) {
    const Descriptor& type = *message.GetDescriptor();
    for (const Scalar& value : statement.values)
        for (int i = 0; i < type.field_count(); ++i)
            if (wordOf(*type.field(i)) == value.text)
                message.GetReflection()->SetBool(&message, type.field(i), true);
}

/// Which of a reference's fields the statement sets.
const FieldDescriptor* choiceOf(const Descriptor& type, const Statement& statement) {
    if (statement.form == Form::Reference)
        return type.FindFieldByName(statement.statements.front().keyword == "node" ? "position"
                                                                                   : "destination");
    const Scalar& value = statement.values.front();
    return type.FindFieldByName(value.kind == Scalar::Kind::Word   ? "off"
                                : value.kind == Scalar::Kind::Text ? "name"
                                                                   : "index");
}

void setReference(const Statement& statement, Message& message) {
    const FieldDescriptor* const field = choiceOf(*message.GetDescriptor(), statement);
    assert(field != nullptr);
    if (isMessage(*field))
        fill(statement.statements, *message.GetReflection()->MutableMessage(&message, field));
    else
        setScalar(statement.values.front(), *field, message);
}

void setMessage(const Statement& statement, const FieldDescriptor& field, Message& inner) {
    const Descriptor& type = *field.message_type();
    if (keywordOf(field).empty())
        return fill({statement}, inner);
    if (isFlags(type))
        return setFlags(statement, inner);
    if (isReference(type))
        return setReference(statement, inner);
    fill(statement.statements, inner);
    if (auto* const node = dynamic_cast<v1::Node*>(&inner))
        node->set_is_application(statement.keyword == "appNode");
}

void addAttributes(const Statement& statement, const FieldDescriptor& field, Message& message) {
    const auto add = [&](const Statement& each) {
        setAttribute(each, dynamic_cast<v1::Attribute&>(
                               *message.GetReflection()->AddMessage(&message, &field)));
    };
    if (keywordOf(field).empty())
        return add(statement);
    for (const Statement& each : statement.statements) add(each);
}

}  // namespace

void fill(const std::vector<Statement>& statements, Message& message) {
    const google::protobuf::Reflection& reflection = *message.GetReflection();
    for (const Statement& statement : statements) {
        const FieldDescriptor* const field = fieldOf(*message.GetDescriptor(), statement);
        assert(field != nullptr);
        if (!isMessage(*field))
            field->is_repeated() ? setList(statement, *field, message)
                                 : setScalar(statement.values.front(), *field, message);
        else if (isAttribute(*field))
            addAttributes(statement, *field, message);
        else
            setMessage(statement, *field,
                       field->is_repeated() ? *reflection.AddMessage(&message, field)
                                            : *reflection.MutableMessage(&message, field));
    }
}

v1::Configuration toMessage(const EqcText& statements) {
    v1::Configuration message;
    message.set_version(statements.version);
    for (const Statement& outer : statements.statements)
        if (outer.keyword == "server")
            for (const Statement& each : outer.statements)
                fill(each.keyword == "config" ? each.statements : std::vector{each}, message);
        else
            fill({outer}, message);
    return message;
}

}  // namespace eyrie::config
