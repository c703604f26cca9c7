// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/frame_data.h"
#include "fabric/image.h"
#include "fabric/range.h"
#include "renderer/draw/drawable.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/gl/object.h"
#include "renderer/gl/pass_state.h"
#include "renderer/occlusion/channel_memory.h"

namespace eyrie::draw {

/// A piece of some object in the order in which a frame draws.
struct OrderedPiece {
    std::uint32_t object;
    Piece piece;
};

/// Where pieces are drawn, and from where they are seen.
struct ChannelDraw {
    const lod::View& view;
    std::span<const fabric::Mat4> worldFromObject;  ///< of each object, as drawn
    /// Drawable::partBounds of the piece's object.
    std::function<std::vector<fabric::Box>(const OrderedPiece&)> partBounds;
    fabric::PixelViewport part;     ///< of the view, that the channel draws
    fabric::PixelViewport covered;  ///< what of it the pieces may touch
    fabric::Range range;
    fabric::Rgba background;
    const gl::PassState& state;
    gl::Framebuffer& framebuffer;  ///< of the view's size or larger
};

/// Draws pieces, less those that others hide, in two passes: first what was not hidden in the
/// channel's last frame; then, of the rest, what is not behind all that is drawn on its pixels.
///
/// The picture is that of all pieces in their order, bit by bit. What is left out is farther than
/// every pixel it could touch. Where depths tie the first piece in order wins, but those of the
/// second pass come late: so it is tested first whether they tie with what is there at any pixel,
/// and if so the picture is drawn again in order. GL thread.
///
/// After N. Greene, M. Kass, G. Miller, "Hierarchical Z-Buffer Visibility", 1993. They remember
/// the list of what was visible; here it is the last frame's depth (occlusion::ChannelMemory).
class OccludedDraw {
public:
    /// Draws pieces in order with the state that is set, and counts them.
    using Pieces = std::vector<const OrderedPiece*>;  ///< ascending
    using DrawPieces = std::function<absl::Status(const Pieces&, fabric::FrameStatistics&)>;

    /// Clears the framebuffer and draws `pieces`; unless `mode` is Off, all of them are filled
    /// opaque surfaces. The last ones may still be being drawn on return.
    absl::Status draw(const ChannelDraw& channel, std::span<const OrderedPiece> pieces,
                      fabric::Occlusion mode, const DrawPieces& drawPieces,
                      fabric::FrameStatistics& statistics);

    /// For another scene.
    void forget() { memories_.clear(); }

private:
    absl::Status drawLooking(const ChannelDraw& channel, std::span<const OrderedPiece> pieces,
                             occlusion::ChannelMemory& memory, const DrawPieces& drawPieces,
                             fabric::FrameStatistics& statistics);
    void remember(const ChannelDraw& channel, occlusion::ChannelMemory& memory);
    absl::StatusOr<bool> doTie(const ChannelDraw& channel, const Pieces& late,
                               const DrawPieces& drawPieces,
                               fabric::FrameStatistics& statistics) const;
    static absl::Status drawAgain(const ChannelDraw& channel, Pieces early, const Pieces& late,
                                  const DrawPieces& drawPieces,
                                  fabric::FrameStatistics& statistics);

    occlusion::ChannelMemories memories_;
    gl::AnySampleQuery anyTie_;
};

}  // namespace eyrie::draw
