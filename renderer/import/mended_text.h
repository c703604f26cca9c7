// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace eyrie::import {

/// A text with replacements, which come from front to back and do not overlap.
class MendedText {
public:
    explicit MendedText(std::string_view source) : source_(source) {}

    void replace(std::size_t at, std::size_t length, std::string_view by) {
        text_.append(source_.substr(copied_, at - copied_)).append(by);
        copied_ = at + length;
        isAny_ = true;
    }

    /// Nothing where nothing was replaced.
    std::optional<std::string> finish() {
        if (!isAny_)
            return std::nullopt;
        text_.append(source_.substr(copied_));
        return std::move(text_);
    }

private:
    std::string_view source_;
    std::string text_;
    std::size_t copied_ = 0;  ///< of the source
    bool isAny_ = false;
};

}  // namespace eyrie::import
