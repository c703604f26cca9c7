// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eyrie::import {

/// Whether a file is a text STL: it begins with "solid", in whatever case, behind blanks, line ends
/// or a byte order mark, and has no zeros where a binary one has its header and a count.
bool isStlText(std::string_view stl);

/// A text STL as Assimp 5.2 reads it, which wants it to begin with its first word, and its words
/// in small letters; nothing for other files.
std::optional<std::string> stlTextForAssimp(std::string_view stl);

}  // namespace eyrie::import
