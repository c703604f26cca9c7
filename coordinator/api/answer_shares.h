// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace eyrie::api {

/// What answers that are being made or sent take up of what there is for all of them. May be used
/// from any thread.
class AnswerShares {
public:
    explicit AnswerShares(std::int64_t most) : most_(most) {}

    /// A share of that size, given back when its last copy goes, which may outlive this. One that
    /// is alone is granted in any case. Null: others take up too much.
    std::shared_ptr<void> take(std::int64_t size) const {
        const std::int64_t before = taken_->fetch_add(size);
        std::shared_ptr<void> share(taken_.get(),
                                    [taken = taken_, size](void*) { *taken -= size; });
        return before == 0 || before + size <= most_ ? share : nullptr;
    }

private:
    using Count = std::atomic<std::int64_t>;

    const std::int64_t most_;
    const std::shared_ptr<Count> taken_ = std::make_shared<Count>(0);
};

}  // namespace eyrie::api
