// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "cli/check/report.h"
#include "coordinator/config/eqc_reader.h"

namespace eyrie::cli::check {
namespace {

using testing::HasSubstr;

TEST(CheckReport, HasEachHostOfANodeOnceThatOfItsRenderersFirst) {
    Checked checked;
    checked.configuration = config::readEqc(
        "config { node { name \"a\" host \"viz\" connection { hostname \"other\" }\n"
        "connection { } connection { hostname \"viz\" } pipe { } } }",
        checked.findings);
    checked.resolved = config::resolve(checked.configuration, checked.findings);
    EXPECT_THAT(json(checked), HasSubstr("\"hosts\": [\"viz\", \"other\"]"));
    EXPECT_THAT(text(checked), HasSubstr("node \"a\", viz, other\n"));
}

}  // namespace
}  // namespace eyrie::cli::check
