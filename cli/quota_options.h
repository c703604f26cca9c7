// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "coordinator/api/quotas.h"
#include "coordinator/http/crowd.h"

/// What may be asked of a coordinator at most.
namespace eyrie::cli {

struct QuotaOptions {
    std::int64_t imagePixels = api::Quotas().imagePixels;
    int sceneObjects = api::Quotas().sceneObjects;
    std::string sceneBytes = "1T";
    std::uint64_t sceneTriangles = api::Quotas().sceneTriangles;
    int callsPerSecond = api::Quotas().callsPerSecond;
    std::size_t readers = api::Quotas().readers;
    http::CrowdLimits crowd = {};
};

void addQuotaOptions(CLI::App& command, QuotaOptions& options);

/// Errors: InvalidArgument (--max-scene-bytes).
absl::StatusOr<api::Quotas> quotasOf(const QuotaOptions& options);

}  // namespace eyrie::cli
