// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <absl/status/status.h>

namespace eyrie::cli {

/// What an option names on the command line: a file to read or to write.
struct NamedFile {
    std::string option;  ///< as it is given, such as "--depth"
    std::string path;    ///< empty: none
};

/// Whether no file to write takes the place of another one, or of one that is read. Devices and
/// pipes take nobody's place. Error: InvalidArgument, naming both options.
absl::Status checkOwnPlaces(std::span<const NamedFile> written, std::span<const NamedFile> read);

}  // namespace eyrie::cli
