// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "coordinator/stream/outbox.h"
#include "coordinator/stream/picture_encoder.h"
#include "coordinator/stream/progress.h"
#include "coordinator/stream/quality.h"

namespace eyrie::stream {

/// Who moves the view of a session.
enum class Role {
    Lead,   ///< leads where nobody does, now or when who leads has left
    Watch,  ///< only when it takes the lead
};

/// What a picture was sent as.
enum class SentAs { Nothing, Jpeg, Png, H264 };

/// The last picture that a browser was given.
struct LastGiven {
    int width = 0;  ///< pixels
    int height = 0;
    SentAs as = SentAs::Nothing;
};

/// One browser in a session: its link, what it has been given and what it is to be given next.
/// Guarded by the session's lock, but for tell() and close().
class Seat {
public:
    /// `messageReady` is called without locks held but the seat's own.
    Seat(std::uint64_t number, Role joinedAs, bool isController, std::string viewerName,
         std::optional<int> framesInFlight, std::function<void()> messageReady)
        : id(number),
          role(joinedAs),
          mayControl(isController),
          viewer(std::move(viewerName)),
          outbox(framesInFlight),
          messageReady_(std::move(messageReady)) {}

    /// What it is to get of the newest picture now; nothing while it has no room, or all there is,
    /// or the picture is not of its screen.
    std::optional<QualityClass> due(const Progress& progress, Clock::time_point now) const;

    /// The same of a picture that moves, however its screen has it.
    std::optional<QualityClass> movingClass(const Picture& picture) const;

    /// A picture drawn now would go to it at once: it has the newest, and room for one more.
    bool isReadyForMore(const Progress& progress) const;

    /// It says that it can show H.264, shows what the leader does, behind no barrier, and is so far
    /// away that a link which looks slow is not just a busy machine.
    bool mayGetVideo() const;
    /// Moving pictures go to it as H.264.
    bool getsVideo() const;

    /// Hands `encoded` of `picture` over, in place of one that waits; to be shown at once, or at
    /// the word for `swap`.
    void give(std::shared_ptr<const EncodedPicture> encoded, const QualityClass& as,
              const Picture& picture, const Progress& progress, Clock::time_point now,
              std::uint64_t swap = 0);

    /// What it shows while `asked` is what the leader asks for; nothing before it is known whether
    /// there is what it wants.
    std::optional<coordinator::Shown> shown(const coordinator::Shown& asked) const;

    /// Says that there may be a message; not any more once close() has returned.
    void tell();
    void close();

    const std::uint64_t id;  ///< among those of the session, from 1
    Role role;
    const bool mayControl;
    const std::string viewer;              ///< Joining's
    std::atomic<bool> isReplaced = false;  ///< its viewer has come again: this one is to end
    const std::chrono::system_clock::time_point joined = std::chrono::system_clock::now();
    Outbox outbox;
    QualityControl quality;
    bool showsVideo = false;          ///< it says that it can
    bool showsTiles = false;          ///< likewise pictures of several JPEGs
    std::optional<VideoPlace> video;  ///< of the last picture of a stream that it was given
    Delivered delivered;              ///< or being made for it
    bool isServed = false;            ///< it is being made
    bool isAwaiting = false;          ///< the picture that is being drawn will go to it at once
    int timesPassedOver = 0;          ///< others came before it since it was served
    std::string problem = {};         ///< why the view that it asked for last has no picture
    std::string refusal = {};         ///< why else its last request came to nothing
    /// A screen of its own, which it shows whoever leads.
    struct Screen {
        coordinator::Shown shown;
        bool isChecked = false;     ///< whether it can be shown
        bool isToBeChecked = true;  ///< as it is now
        std::string problem = {};   ///< why it cannot; empty where it can
    };
    std::optional<Screen> screen;
    std::string barrier = {};  ///< that its pictures are shown behind; empty: none
    std::string lastState = {};
    LastGiven last;

    /// Pictures that it was given.
    std::uint64_t given() const { return lastFrameNumber_; }

private:
    std::uint64_t lastFrameNumber_ = 0;
    std::mutex telling_;  ///< guards what follows
    std::function<void()> messageReady_;
};

}  // namespace eyrie::stream
