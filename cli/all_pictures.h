// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/frame/shown.h"

namespace eyrie::cli {

/// A picture that a configuration shows at first, each a window of its own: of one segment, for one
/// eye.
struct NamedPicture {
    std::string name;  ///< CANVAS.SEGMENT, with .left or .right where the view is stereo
    coordinator::Shown shown;
};

/// All of them, as canvases and segments are written. Things without a name are called by their
/// position; letters other than a-z, A-Z, 0-9 and "-" become "_"; no two names are the same.
std::vector<NamedPicture> allPictures(const config::Configuration& configuration);

/// `path` with `name` before its ending: "out.png" and "0.1.left" are "out.0.1.left.png".
std::string pathOf(const std::string& path, std::string_view name);

}  // namespace eyrie::cli
