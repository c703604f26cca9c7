// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include <google/protobuf/descriptor.h>

#include "eyrie/v1/configuration.pb.h"

/// How fields of configuration.proto stand in a .eqc file. For the sources of this folder only: it
/// shows protobuf.
namespace eyrie::config {

using google::protobuf::Descriptor;
using google::protobuf::EnumValueDescriptor;
using google::protobuf::FieldDescriptor;

/// Empty where what is inside has no block around it.
inline std::string keywordOf(const FieldDescriptor& field) {
    return field.options().HasExtension(v1::keyword) ? field.options().GetExtension(v1::keyword)
                                                     : field.name();
}

inline std::string wordOf(const EnumValueDescriptor& value) {
    if (value.options().HasExtension(v1::word))
        return value.options().GetExtension(v1::word);
    const std::string& zero = value.type()->value(0)->name();  // …_UNSPECIFIED
    return value.name().substr(zero.size() - std::string("UNSPECIFIED").size());
}

/// Of a flag, such as DRAW of draw.
inline std::string wordOf(const FieldDescriptor& flag) {
    std::string word = flag.name();
    std::ranges::transform(word, word.begin(), [](char each) {
        return each >= 'a' && each <= 'z' ? static_cast<char>(each - 'a' + 'A') : each;
    });
    return word;
}

inline bool isAttribute(const FieldDescriptor& field) {
    return field.message_type() == v1::Attribute::descriptor();
}

/// A set of words, such as Tasks.
inline bool isFlags(const Descriptor& type) {
    for (int i = 0; i < type.field_count(); ++i)
        if (type.field(i)->cpp_type() != FieldDescriptor::CPPTYPE_BOOL)
            return false;
    return type.field_count() > 0;
}

/// A name, a position, or what stands in ( ).
inline bool isReference(const Descriptor& type) {
    return type.FindFieldByName("to") == nullptr && type.FindOneofByName("to") != nullptr;
}

}  // namespace eyrie::config
