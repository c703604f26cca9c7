// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "cli/bench/reference_sources.h"
#include "renderer/lod/view.h"
#include "renderer/page/page_source.h"
#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/shown_surface.h"
#include "renderer/truth/triangle.h"

namespace eyrie::cli::bench {

/// The drawn triangles of one picture, for the few pixels whose depth alone does not tell what they
/// show (truth::Suspects): read from the imports when the first is asked for. All that is given is
/// referred to.
class ShownTriangles {
public:
    ShownTriangles(const ReferenceScene& scene, const truth::Pinhole& camera, const lod::View& view,
                   double tauPixels, const page::SourceOptions& remote)
        : scene_(scene), camera_(camera), view_(view), tauPixels_(tauPixels), remote_(remote) {}

    /// Its source is its object's place in the scene. Any thread may ask. Nothing where no triangle
    /// covers the picture point, or the import cannot be read.
    std::optional<truth::DrawnPoint> at(double x, double y, double depthMetres);

private:
    void read();
    void add(const ReferenceScene::Object& object);

    const ReferenceScene& scene_;
    const truth::Pinhole& camera_;
    const lod::View view_;
    const double tauPixels_;
    const page::SourceOptions& remote_;
    std::once_flag isRead_;
    std::vector<truth::Triangle> triangles_;
    std::vector<std::size_t> ends_;               ///< of each object's triangles
    std::optional<truth::ShownSurface> surface_;  ///< of those
};

}  // namespace eyrie::cli::bench
