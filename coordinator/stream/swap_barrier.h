// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/frame/frame_source.h"

namespace eyrie::stream {

/// The swap barrier that this picture is shown behind; empty: none, or there is no such picture.
std::string swapBarrierOf(const std::vector<coordinator::CanvasStatus>& canvases,
                          const coordinator::Shown& shown);

}  // namespace eyrie::stream
