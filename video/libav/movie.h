// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "video/module.h"

namespace eyrie::video {

/// See Module::makeMovie.
absl::StatusOr<std::unique_ptr<Movie>> makeMovie(const MovieSettings& settings, MovieSink sink);

}  // namespace eyrie::video
