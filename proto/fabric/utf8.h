// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace eyrie::fabric {

/// Bytes of the UTF-8 character that `text` begins with; 0 where it begins with none. The forms
/// that Unicode forbids (overlong, surrogates, beyond U+10FFFF) are none.
std::size_t utf8Length(std::string_view text);

}  // namespace eyrie::fabric
