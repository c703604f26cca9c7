// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "video/module.h"

namespace eyrie::stream {

/// Makes streams of pictures that are only counted.
class FakeVideo final : public video::Module {
public:
    absl::StatusOr<std::unique_ptr<video::StreamEncoder>> makeStream(
        const video::StreamSettings&) const override {
        ++streams;
        return std::make_unique<Encoder>(*this);
    }

    absl::StatusOr<std::unique_ptr<video::Movie>> makeMovie(const video::MovieSettings&,
                                                            video::MovieSink) const override {
        return absl::UnimplementedError("streams only");
    }

    mutable std::atomic<int> streams = 0;
    std::atomic<bool> isBroken = false;  ///< no picture can be coded

private:
    class Encoder final : public video::StreamEncoder {
    public:
        explicit Encoder(const FakeVideo& fake) : fake_(fake) {}

        absl::StatusOr<video::StreamPicture> encode(const fabric::Image&, bool asKey) override {
            if (fake_.isBroken)
                return absl::InternalError("the encoder is broken");
            video::StreamPicture picture{std::vector<std::byte>(200), asKey || isFirst_};
            isFirst_ = false;
            return picture;
        }

    private:
        const FakeVideo& fake_;
        bool isFirst_ = true;
    };
};

}  // namespace eyrie::stream
