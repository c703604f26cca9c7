// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eyrie::api {

/// A JSON object in the making: members in the order in which they came.
class JsonMembers {
public:
    JsonMembers& text(std::string_view name, std::string_view value);
    /// `json` is put in as it is.
    JsonMembers& raw(std::string_view name, std::string_view json);
    bool isEmpty() const { return members_.empty(); }
    std::string str() const { return "{" + members_ + "}"; }

private:
    std::string members_;
};

/// A JSON list of what is JSON already.
std::string jsonList(const std::vector<std::string>& elements);

}  // namespace eyrie::api
