// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

namespace eyrie::api {

/// Who may read a file that is written: whom the process's mask lets, or nobody but its user, as
/// of addresses with passwords in them.
enum class Readers { Others, OwnerAlone };

/// Writes `text` in place of what `path` has. By way of a file of its own, so that neither another
/// writer nor who reads meanwhile sees a part, nor anybody after the power has failed. Killed on
/// the way, it leaves a hidden file.
std::error_code replaceFile(const std::filesystem::path& path, std::string_view text,
                            Readers readers);

}  // namespace eyrie::api
