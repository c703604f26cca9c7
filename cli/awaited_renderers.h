// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::cli {

/// Renderers that are to draw before the first picture is asked for: by default it is shared out
/// among those that have the scene open by then.
struct AwaitedRenderers {
    int count = 1;        ///< that are wanted, of this machine or others
    int started = 1;      ///< of our own
    std::string sockets;  ///< what the addresses of our own begin with
};

/// How many have the scene open and get parts of pictures.
int drawingRenderers(const coordinator::Status& status);

/// Whether as many as awaited draw, and frames can be had. Errors: that of a renderer of our own
/// that is refused, where too few are left.
absl::StatusOr<bool> areThere(const AwaitedRenderers& awaited, const coordinator::Status& status);

}  // namespace eyrie::cli
