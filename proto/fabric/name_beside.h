// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::fabric {

/// PATH and `ending`: a file that goes with the one at `path`. Where that name would be longer than
/// the 255 bytes that names may have, what is too much of the path's own gives way to a hash of it,
/// so that each path has its own. Equal on all machines, and the same but for `ending` for endings
/// of one length.
std::string nameBeside(const std::string& path, std::string_view ending);

}  // namespace eyrie::fabric
