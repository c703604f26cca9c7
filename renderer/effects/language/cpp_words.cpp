// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/cpp_words.h"

#include <algorithm>
#include <array>

namespace eyrie::effects {
namespace {

/// C++20's keywords of letters only, and contextual names of macros in <cerrno> and <cassert>.
constexpr std::array<std::string_view, 84> kTaken{
    "alignas",   "alignof",   "and",       "asm",      "auto",     "bitand",   "bitor",   "bool",
    "break",     "case",      "catch",     "char",     "class",    "compl",    "concept", "const",
    "consteval", "constexpr", "constinit", "continue", "decltype", "default",  "delete",  "do",
    "double",    "else",      "enum",      "explicit", "export",   "extern",   "false",   "float",
    "for",       "friend",    "goto",      "if",       "inline",   "int",      "long",    "mutable",
    "namespace", "new",       "noexcept",  "not",      "nullptr",  "operator", "or",      "private",
    "protected", "public",    "register",  "requires", "return",   "short",    "signed",  "sizeof",
    "static",    "struct",    "switch",    "template", "this",     "throw",    "true",    "try",
    "typedef",   "typeid",    "typename",  "union",    "unsigned", "using",    "virtual", "void",
    "volatile",  "while",     "xor",       "assert",   "errno",    "builtIn",  "create",  "use",
    "value",     "variant",   "program",   "linux",
};

}  // namespace

bool isTakenInCpp(std::string_view name) {
    return std::find(kTaken.begin(), kTaken.end(), name) != kTaken.end();
}

}  // namespace eyrie::effects
