// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/renderer.h"
#include "service/channel_drawer.h"

namespace eyrie::service {

/// Makes an eyrie::Renderer, on the thread that calls it.
DrawerFactory rendererDrawer(const RendererOptions& options);

}  // namespace eyrie::service
