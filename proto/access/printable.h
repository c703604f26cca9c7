// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::access {

/// Whether `text` is UTF-8, without the forms that Unicode forbids (overlong, surrogates).
bool isUtf8(std::string_view text);

/// What a stranger sent, fit for a message or a log: at most 200 bytes, and no more than ASCII
/// without control characters; other bytes are \xNN.
std::string printable(std::string_view text);

/// Our words with a stranger's among them, as a file's names are, fit for a terminal: UTF-8, of any
/// length; control characters and bytes that are no UTF-8 are \xNN.
std::string printableUtf8(std::string_view text);

}  // namespace eyrie::access
