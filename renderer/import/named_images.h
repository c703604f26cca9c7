// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// The names of images in a file of whatever format, text or not: what ends as these do, from the
/// quote, bracket, semicolon or control character before it. Sorted, each once, as many as the
/// first that a model may show.
std::vector<std::string> imagesNamedIn(std::string_view bytes);

/// Whether a file's name ends as an image's does.
bool isImageName(std::string_view name);

}  // namespace eyrie::import
