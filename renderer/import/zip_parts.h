// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace eyrie::import {

/// Calls `use` with each part of a ZIP archive whose name ends so, unpacked, as far as they can be
/// read: of what cannot be, and of files that are no archive, who reads the file tells. In a
/// process that may fail (reading_process.h): parts may be of any size. Errors: those of `use`, at
/// the first.
absl::Status forEachZipPart(const std::string& path, std::string_view ending,
                            const std::function<absl::Status(std::string_view part)>& use);

}  // namespace eyrie::import
