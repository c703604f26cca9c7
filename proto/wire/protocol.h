// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::wire {

/// Raised by hand by every change after which a renderer may draw other pixels, or promise another
/// error, for the same task: renderers that differ in it do not draw parts of one picture.
inline constexpr std::uint64_t kPictureVersion = 2;

/// Sum of all that processes say to each other (the calls of both services, their messages, every
/// field's number and type) and of the pictures that they draw. Two builds with the same one
/// understand each other to the last field.
std::uint64_t protocolChecksum(std::uint64_t pictureVersion = kPictureVersion);

}  // namespace eyrie::wire
