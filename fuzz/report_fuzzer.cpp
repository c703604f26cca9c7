// SPDX-License-Identifier: Apache-2.0
// What other runs of the program have written as JSON, of any bytes: reports of `eyrie bench`, as
// --compare reads them, and what `eyrie info` says of a file.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "cli/bench/summary_file.h"
#include "coordinator/api/data_sets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie;
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (const auto set = api::dataSetOf(text);
        set.ok() && (set->levels() < 0 || set->bytes() < 0 || set->triangles() < 0))
        std::abort();
    const int fd = memfd_create("report", MFD_CLOEXEC);
    if (fd < 0 || write(fd, data, size) < 0)
        std::abort();
    const auto report = cli::bench::readReport("/proc/self/fd/" + std::to_string(fd));
    close(fd);
    if (!report.ok() && report.status().code() != absl::StatusCode::kInvalidArgument)
        std::abort();
    if (report.ok())
        for (const auto& run : report->runs)
            if (!(run.frame.p50 >= 0) || run.renderers < 0)
                std::abort();
    return 0;
}
