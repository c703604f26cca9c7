// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <absl/status/status.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::stream {

struct ViewerOptions {
    /// Frames that may be under way at once; absent leaves it to the Pacer's rule.
    std::optional<int> framesInFlight;
    /// How long a view rests before it is sent once more, nearly exact and then exact.
    std::chrono::milliseconds restDelay{150};
    /// How long after a failed frame the same view is tried again.
    std::chrono::milliseconds retryDelay{1000};
    /// After a frame that shows less than it should because data are still being loaded, the same
    /// view is drawn again, with this pause for the loading.
    std::chrono::milliseconds loadingDelay{30};
    /// The same when all that is missing could not be read, and may be readable later.
    std::chrono::milliseconds missingDelay{5000};
};

/// One browser's stream of frames, without the network: bytes come in by receive() and go out by
/// takeMessage(), so nothing is ever queued for a browser that does not keep up.
///
/// The newest view request replaces the one before. Render threads have it drawn, several frames at
/// once where renderers would be idle, while another thread encodes the frame before. At most as
/// many frames are under way as the Pacer says, each as large as QualityControl says, and an
/// encoded frame that still waits is replaced by a newer one. A view that rests is sent as a JPEG
/// of quality 95, and then as a PNG that is the server's picture bit for bit; what has not been
/// sent of them when it moves again never is. Nothing is rendered or sent while neither the view
/// nor the scene nor the renderers change and the last frame is complete. A frame that fails leaves
/// the last picture in place and becomes the state's problem text.
///
/// All functions may be called from any thread.
class Viewer {
public:
    /// Calls `messageReady`, from any thread and without locks held, when takeMessage() may have
    /// something new. `frames` outlives the viewer.
    Viewer(coordinator::FrameSource& frames, std::function<void()> messageReady,
           const ViewerOptions& options = {});

    /// Waits for the frames being rendered. `messageReady` is not called afterwards.
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Takes a message from the browser. DataLoss when it is not in the protocol, after which the
    /// connection is to be closed. A view that cannot be drawn is no error: the browser is told.
    absl::Status receive(std::span<const std::byte> message);

    /// The next message to send, if any: the newest answer to a pick, else the newest state, else
    /// what follows of a picture.
    std::optional<std::string> takeMessage();

    /// How long a message without weight took to the browser and back.
    void roundTrip(std::chrono::steady_clock::duration time);

    /// For how long the oldest picture, or part of one, has been under way that the browser has not
    /// acknowledged; absent while there is none.
    std::optional<std::chrono::steady_clock::duration> unacknowledgedFor() const;

    /// Makes the threads end soon, without waiting for them; the destructor waits.
    void stop();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::stream
