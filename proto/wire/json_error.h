// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::wire {

/// What is wrong in JSON that should be a message.
struct JsonError {
    std::string field;       ///< as in the JSON, such as "keys[2].camera"; empty: all of the text
    bool isUnknown = false;  ///< there is no such field
    std::string what;        ///< else: what stands there, and what must

    /// "there is no field 'keys[2].kamera'", "eye[2] is "x"; it must be a number".
    std::string text() const;
};

/// What protobuf says of it, which names its own types and its C++ spelling of fields. Words that
/// are not known stay as they are.
JsonError jsonError(std::string_view words);

}  // namespace eyrie::wire
