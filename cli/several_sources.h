// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// What is said of the sources of one import together.
namespace eyrie::cli {

/// For progress bars and messages: "a.tif", "a.tif and 2 more". Precondition: there are some.
std::string titleOf(const std::vector<std::string>& sources);

/// Of all together, as far as they are files here.
double megabytesOf(const std::vector<std::string>& sources);

}  // namespace eyrie::cli
