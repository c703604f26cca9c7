// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/page/remote_name.h"
#include "renderer/renderer.h"
#include "service/channel_drawer.h"

namespace eyrie::service {

/// Makes an eyrie::Renderer, on the thread that calls it. A scene that names a URL beyond `allowed`
/// is refused: whoever reaches a renderer could else have it read from servers that only it
/// reaches.
DrawerFactory rendererDrawer(const RendererOptions& options, const page::AllowedUrls& allowed);

}  // namespace eyrie::service
