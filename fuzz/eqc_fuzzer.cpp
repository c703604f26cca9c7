// SPDX-License-Identifier: Apache-2.0
// Configurations of any bytes, JSON where they begin with a brace: read with all that is wrong in
// them, and where nothing is, resolved, and written in both forms, which must be read as the same;
// then planned, as configured and small, and shared out to renderers that exchange pictures.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "coordinator/compound/exchange.h"
#include "coordinator/compound/plan.h"
#include "coordinator/compound/plan_check.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/resolved.h"

namespace {

void planSmall(const eyrie::config::Configuration& configuration, std::uint64_t frame) {
    using namespace eyrie::compound;
    for (std::size_t i = 0; i < configuration.canvases.size(); ++i) {
        PlanRequest request;
        request.outputs.resize(1);
        request.outputs[0].canvas = i;
        request.outputs[0].size = eyrie::config::PixelSize{17, 11};
        request.frameNumber = frame;
        const auto plan = makePlan(configuration, request);
        if (plan.ok())
            static_cast<void>(exchangeOf(*plan, frame));
        else if (plan.status().code() != absl::StatusCode::kInvalidArgument)
            std::abort();
    }
}

}  // namespace

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
    if (findings.hasErrors())
        return 0;
    eyrie::compound::checkPlans(configuration, findings);
    planSmall(configuration, size % 60);
    return 0;
}
