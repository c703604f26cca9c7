// SPDX-License-Identifier: Apache-2.0
// Configurations of any bytes: read with all that is wrong in them, and resolved where nothing is.
#include <cstdint>
#include <string_view>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::config;
    Findings findings;
    const Configuration configuration =
        readEqc(std::string_view(reinterpret_cast<const char*>(data), size), findings);
    if (!findings.hasErrors())
        resolve(configuration, findings);
    static_cast<void>(describe(findings, "fuzzed.eqc"));
    return 0;
}
