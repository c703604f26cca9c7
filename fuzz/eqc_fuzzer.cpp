// SPDX-License-Identifier: Apache-2.0
// Configurations of any bytes, JSON where they begin with a brace: read with all that is wrong in
// them, and where nothing is, resolved, and written in both forms, which must be read as the same.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/resolved.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::config;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    Findings findings;
    const Configuration configuration =
        text.starts_with('{') ? readJson(text, findings) : readEqc(text, findings);
    static_cast<void>(describe(findings, "fuzzed"));
    if (findings.hasErrors())
        return 0;
    if (readStatements(parseEqc(writeEqc(configuration), findings), findings) != configuration ||
        readJson(writeJson(configuration), findings) != configuration)
        std::abort();
    resolve(configuration, findings);
    return 0;
}
