// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/box.h"
#include "fabric/camera_path.h"
#include "fabric/flight.h"

namespace eyrie::cli::bench {

/// Once around `bounds` in 12 seconds, from 30 degrees above.
fabric::Flight orbit(const fabric::Box& bounds);

/// An S from one end of `bounds` to the other in 12 seconds, just above its highest point, looking
/// ahead and a little down.
fabric::Flight walkthrough(const fabric::Box& bounds);

/// What is hardest on caches and on anything that trusts the last frame, 24 shots of half a second
/// with a hard cut after each: along the data, turned by 180 degrees at every cut; from one end of
/// the data to another; and jumps between near and five diagonals away. Cuts last a nanosecond, so
/// no frame of a pass of fabric::Flight's seconds in up to 100,000 even steps falls into one.
fabric::Flight worst(const fabric::Box& bounds);

/// A flight by what it is called on the command line: "orbit", "walkthrough", "worst", or a file,
/// which is a flight as JSON or a camera path of older programs. A file is read once: a pipe will
/// do, and all runs play the same.
class NamedFlight {
public:
    /// Errors: those of readText.
    static absl::StatusOr<NamedFlight> read(std::string name);

    const std::string& name() const { return name_; }
    /// Tells what is played by one name from another: xxh64 of a file's text, of none otherwise.
    std::uint64_t hash() const;

    /// Over data within `bounds`. Only older programs' paths have a note; their cameras get the
    /// field of view that fabric::Camera has. Errors, with the file's name: those of
    /// wire::flightFromJson and fabric::cameraPathFromText.
    absl::StatusOr<fabric::CameraPath> over(const fabric::Box& bounds) const;

private:
    NamedFlight(std::string name, std::string text)
        : name_(std::move(name)), text_(std::move(text)) {}

    std::string name_;
    std::string text_;  ///< of a file
};

/// `count` (at least 1) keys, evenly in time from the flight's first to its last: what is drawn of
/// it. InvalidArgument, naming the second and the keys around it, where the curve between two good
/// keys leads through a camera that fabric::validate refuses.
absl::StatusOr<std::vector<fabric::FlightKey>> framesOf(const fabric::Flight& flight, int count);

}  // namespace eyrie::cli::bench
