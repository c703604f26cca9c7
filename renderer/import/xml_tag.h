// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// XML as text, one tag at a time: enough to mend single attributes before another reads the file.
namespace eyrie::import {

/// The end of the tag that begins `text`: behind its '>' outside of quotes.
std::size_t endOfTag(std::string_view text);

/// The value of an attribute of `tag`, a part of it, as it stands there; empty where there is none.
std::string_view xmlAttribute(std::string_view tag, std::string_view name);

/// `tag` with something else for `value`, a part of it.
std::string withValue(std::string_view tag, std::string_view value, std::string_view other);

}  // namespace eyrie::import
