// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fabric/image.h"
#include "video/libav/owners.h"

namespace eyrie::video {

/// Decodes what was encoded, by libavcodec's own H.264 decoder.
class Decoder {
public:
    Decoder() : context_(avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_H264))) {
        context_->flags |= AV_CODEC_FLAG_LOW_DELAY;
        context_->err_recognition = AV_EF_EXPLODE;
        avcodec_open2(context_.get(), nullptr, nullptr);
    }

    /// Its frame; null where it gives none at once.
    Frame decode(std::span<const std::byte> bytes) {
        Packet packet(av_packet_alloc());
        av_new_packet(packet.get(), static_cast<int>(bytes.size()));
        std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::byte*>(packet->data));
        if (avcodec_send_packet(context_.get(), packet.get()) != 0)
            return nullptr;
        Frame frame(av_frame_alloc());
        return avcodec_receive_frame(context_.get(), frame.get()) == 0 ? std::move(frame) : nullptr;
    }

private:
    Context context_;
};

/// The frames of a file's one track, in the order of their times; none where it is no video.
inline std::vector<Frame> framesOfFile(const std::string& path) {
    std::vector<Frame> frames;
    AVFormatContext* input = nullptr;
    if (avformat_open_input(&input, path.c_str(), nullptr, nullptr) != 0)
        return frames;
    if (avformat_find_stream_info(input, nullptr) >= 0 && input->nb_streams == 1) {
        const AVCodecParameters* track = input->streams[0]->codecpar;
        const Context context(avcodec_alloc_context3(avcodec_find_decoder(track->codec_id)));
        avcodec_parameters_to_context(context.get(), track);
        avcodec_open2(context.get(), nullptr, nullptr);
        const Packet packet(av_packet_alloc());
        const auto take = [&] {
            for (;;) {
                Frame frame(av_frame_alloc());
                if (avcodec_receive_frame(context.get(), frame.get()) != 0)
                    return;
                frames.push_back(std::move(frame));
            }
        };
        for (; av_read_frame(input, packet.get()) == 0; av_packet_unref(packet.get())) {
            avcodec_send_packet(context.get(), packet.get());
            take();
        }
        avcodec_send_packet(context.get(), nullptr);
        take();
    }
    avformat_close_input(&input);
    return frames;
}

/// Of a BT.709 frame of limited range, in floating point: red, green and blue of a pixel.
inline std::array<double, 3> colourAt(const AVFrame& frame, int x, int fromTop) {
    const auto at = [&](int plane, int px, int py) {
        return double{static_cast<double>(
            frame.data[plane][std::ptrdiff_t{py} * frame.linesize[plane] + px])};
    };
    const double y = (at(0, x, fromTop) - 16) / 219;
    const double b = (at(1, x / 2, fromTop / 2) - 128) / 224;
    const double r = (at(2, x / 2, fromTop / 2) - 128) / 224;
    return {255 * (y + 1.5748 * r), 255 * (y - 0.1873 * b - 0.4681 * r), 255 * (y + 1.8556 * b)};
}

/// Decibels of a decoded frame's colours against the picture that it is to show.
inline double psnr(const AVFrame& frame, const fabric::Image& image) {
    double sum = 0;
    for (int y = 0; y < image.area.height; ++y)
        for (int x = 0; x < image.area.width; ++x) {
            const auto seen = colourAt(frame, x, image.area.height - 1 - y);
            const fabric::Rgba& c = image.colour[static_cast<std::size_t>(y) *
                                                     static_cast<std::size_t>(image.area.width) +
                                                 static_cast<std::size_t>(x)];
            for (const double off : {seen[0] - c.r, seen[1] - c.g, seen[2] - c.b}) sum += off * off;
        }
    return 10 * std::log10(255.0 * 255 * 3 * static_cast<double>(image.area.area()) / sum);
}

/// Hills and valleys of colour that move with time, and an edge.
inline fabric::Image movingPicture(int width, int height, int time) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, {}, false);
    std::size_t i = 0;
    const auto wave = [](double phase) {
        return static_cast<std::uint8_t>(128 + 100 * std::sin(phase));
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i)
            image.colour[i] = x + 2 * y < width / 2 + 3 * time
                                  ? fabric::Rgba{220, 40, 30, 255}
                                  : fabric::Rgba{wave((x + 2 * time) / 17.0), wave(y / 11.0),
                                                 wave((x + y - time) / 23.0), 255};
    return image;
}

}  // namespace eyrie::video
