// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "coordinator/stream/outbox.h"
#include "coordinator/stream/quality.h"
#include "eyrie/v1/viewer.pb.h"

namespace eyrie::stream {

/// A server that draws as fast as it may, a link with a rate and a delay, and a browser that
/// decodes one picture after the other, in steps of half a millisecond of made-up time. The link
/// keeps all it is given in a queue of its own, as those of real networks do.
class SimulatedLink {
public:
    using Time = std::chrono::duration<double, std::milli>;

    struct Settings {
        std::function<double(Time)> megabits;
        Time roundTrip{50};
        Time rendering{12};
        Time encoding{3};
        Time decoding{8};
        /// What the browser's threads take before they see a message, and up to how much more.
        Time threads{0};
        Time hiccups{0};
        /// How often the page takes its input and sends a view; 0: with each acknowledgement, which
        /// is when a frame may start.
        Time viewsEvery{0};
        double bytesAtBest = 52'000;  ///< a moving frame of 1280x720 at level 0
        bool showsVideo = false;      ///< H.264 may be sent
    };

    /// A frame on the canvas.
    struct Drawn {
        Time at;
        Time latency;  ///< since the input that it shows
        int level;
        Codec codec;
    };

    explicit SimulatedLink(Settings settings) : settings_(std::move(settings)), outbox_({}) {}

    std::vector<Drawn> run(Time duration) {
        for (; now_ < duration; now_ += kStep) step();
        return drawn_;
    }

private:
    static constexpr Time kStep{0.5};
    static constexpr double kPixels = 1280 * 720;
    struct Made {
        Time input;
        int level = 0;
        Codec codec = Codec::Jpeg;
    };
    struct Packet {
        Time at;  ///< when it comes out
        std::string message;
    };

    Clock::time_point clock() const {
        return Clock::time_point(std::chrono::duration_cast<Clock::duration>(now_));
    }

    void step() {
        render();
        send();
        receive();
        for (; !acks_.empty() && acks_.front().first <= now_; acks_.pop_front())
            outbox_.acknowledged(acks_.front().second, clock());
        for (; !pongs_.empty() && pongs_.front().at <= now_; pongs_.pop_front())
            outbox_.roundTrip(std::chrono::duration_cast<Clock::duration>(pongs_.front().took),
                              clock());
    }

    /// Drawing and encoding, one after the other here; the view moves all the time.
    void render() {
        if (isRendering_ && now_ >= renderedAt_) {
            isRendering_ = false;
            outbox_.rendered(std::chrono::duration_cast<Clock::duration>(settings_.rendering));
            const double noise = 0.9 + 0.002 * static_cast<double>(frameNumber_ * 37 % 100);
            EncodedFrame encoded;
            encoded.frameNumber = frameNumber_;
            EncodedPicture picture;
            picture.bytes.resize(static_cast<std::size_t>(noise * settings_.bytesAtBest * share()));
            if (!isKey())
                quality_.encoded(level_, picture.bytes.size(), kPixels, codec_);
            streamLevel_ = codec_ == Codec::H264 ? level_ : -1;
            encoded.picture = std::make_shared<const EncodedPicture>(std::move(picture));
            outbox_.putFrame({std::move(encoded), frame_, startedAt_});
        }
        if (!isRendering_ && outbox_.hasRoom(0)) {
            quality_.adapt(outbox_.link().bytesPerSecond(clock()), kPixels, clock(),
                           settings_.showsVideo);
            level_ = quality_.index();
            codec_ = quality_.codec();
            isRendering_ = true;
            startedAt_ = clock();
            renderedAt_ = now_ + settings_.rendering +
                          settings_.encoding * (codec_ == Codec::H264 ? kVideoEffort : 1);
            made_[++frameNumber_] = {inputOf(now_ - settings_.roundTrip / 2), level_, codec_};
        }
    }

    /// The first of a stream, and the first after it has been at another level.
    bool isKey() const { return codec_ == Codec::H264 && streamLevel_ != level_; }

    /// Of the bytes that the best JPEG takes.
    double share() const {
        return isKey()                 ? kKeyShare
               : codec_ == Codec::H264 ? videoSizes_.at(level_)
                                       : sizes_[level_];
    }

    /// When the newest input was made of those sent by then: on average half an interval before it
    /// was taken.
    Time inputOf(Time sent) const {
        const Time every = settings_.viewsEvery;
        return every == Time(0) ? sent : every * (std::floor(sent / every) - 0.5);
    }

    void send() {
        while (std::optional<std::string> message = outbox_.take(clock())) {
            if (pingedAt_ + Time(1000) <= now_) {
                pingedAt_ = now_;
                const Time out = std::max(linkFree_, now_);
                pongs_.push_back({out + settings_.roundTrip, out + settings_.roundTrip - now_});
            }
            const double bits = 8.0 * static_cast<double>(message->size());
            linkFree_ = std::max(linkFree_, now_) + Time(bits / (1000 * settings_.megabits(now_)));
            packets_.push_back({linkFree_ + settings_.roundTrip / 2, *std::move(message)});
        }
    }

    void receive() {
        for (; !packets_.empty() && packets_.front().at <= now_; packets_.pop_front()) {
            v1::ViewerResponse response;
            response.ParseFromString(packets_.front().message);
            const std::uint64_t number = response.frame().frame_number();
            const double share = static_cast<double>(number * 61 % 89) / 89.0;
            const Time seen =
                std::max(now_ + settings_.threads + share * settings_.hiccups, seenAt_);
            seenAt_ = seen;
            const Time at = std::max(decoderFree_, seen) + settings_.decoding;
            decoderFree_ = at;
            drawn_.push_back(
                {at, at - made_[number].input, made_[number].level, made_[number].codec});
            FrameAck ack{number};
            ack.decoding = at - seen;
            acks_.emplace_back(at + settings_.roundTrip / 2, ack);
        }
    }

    /// What the levels take of the best one: measured of a terrain picture, docs/benchmarks.md,
    /// and not what QualityControl believes.
    const std::vector<double> sizes_ = {1, .78, .70, .61, .49, .37, .25, .19, .13};
    /// The same of streams (bench/codecs), of their keys, and of the time that coding takes.
    const std::map<int, double> videoSizes_ = {{0, .25}, {4, .11}, {6, .05}};
    static constexpr double kKeyShare = 1.1;
    static constexpr double kVideoEffort = 2.4;
    const Settings settings_;
    const std::shared_ptr<const coordinator::RenderedFrame> frame_ =
        std::make_shared<coordinator::RenderedFrame>();
    struct Pong {
        Time at;
        Time took;
    };

    Time now_{0};
    Outbox outbox_;
    QualityControl quality_;
    bool isRendering_ = false;
    int level_ = 0;
    Codec codec_ = Codec::Jpeg;
    int streamLevel_ = -1;  ///< of the last frame, if it was of a stream
    Time renderedAt_{0};
    Clock::time_point startedAt_;
    std::uint64_t frameNumber_ = 0;
    std::map<std::uint64_t, Made> made_;
    Time linkFree_{0};
    Time pingedAt_{-1000};
    Time seenAt_{0};
    Time decoderFree_{0};
    std::deque<Packet> packets_;
    std::deque<std::pair<Time, FrameAck>> acks_;
    std::deque<Pong> pongs_;
    std::vector<Drawn> drawn_;
};

}  // namespace eyrie::stream
