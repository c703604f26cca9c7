// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tbb/global_control.h>

namespace eyrie::import {

/// While it lives, no more than `threads` of this process work at once; 0: as many as there are
/// cores.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads)
        : control_(tbb::global_control::max_allowed_parallelism,
                   threads > 0 ? static_cast<std::size_t>(threads) : current()) {}

    static std::size_t current() {
        return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    }

private:
    tbb::global_control control_;
};

/// How many GDAL's warper may use, as it wants to be told, of a raster that is opened now.
inline std::string gdalThreads() { return std::to_string(ThreadLimit::current()); }

}  // namespace eyrie::import
