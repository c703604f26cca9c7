// SPDX-License-Identifier: Apache-2.0
#include "cli/quota_options.h"

#include "cli/options/whole_number.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

constexpr int kMany = 1'000'000;

}  // namespace

void addQuotaOptions(CLI::App& command, QuotaOptions& options) {
    command
        .add_option("--max-image-pixels", options.imagePixels,
                    "Pixels of a picture for a program; more come in parts")
        ->check(CLI::Range(std::int64_t{1}, api::Quotas::kMostImagePixels))
        ->capture_default_str();
    command.add_option("--max-scene-objects", options.sceneObjects, "Objects of a program's scene")
        ->check(CLI::Range(1, 10'000))
        ->capture_default_str();
    command
        .add_option("--max-scene-bytes", options.sceneBytes,
                    "Of the files in --data that such a scene names, together")
        ->type_name("BYTES[K|M|G|T]")
        ->capture_default_str();
    command
        .add_option("--max-scene-triangles", options.sceneTriangles,
                    "Of such a scene, at full resolution; 0: any number")
        ->transform(wholeNumber())
        ->capture_default_str();
    command
        .add_option("--max-calls-per-second", options.callsPerSecond,
                    "Of programs at one address; 0: any number")
        ->check(CLI::Range(0, kMany))
        ->capture_default_str();
    command
        .add_option("--max-statistics-readers", options.readers,
                    "Programs that watch statistics at a time")
        ->check(CLI::Range(0, kMany))
        ->capture_default_str();
    command.add_option("--max-viewers", options.crowd.viewers, "Browsers that are shown something")
        ->check(CLI::Range(1, kMany))
        ->capture_default_str();
    command
        .add_option("--max-viewers-per-address", options.crowd.viewersPerAddress,
                    "Of those; 0: any number, as where a proxy stands before them")
        ->check(CLI::Range(0, kMany))
        ->capture_default_str();
    command
        .add_option("--max-sessions", options.crowd.sessions,
                    "Views that are drawn for them: those who share one count as one")
        ->check(CLI::Range(1, kMany))
        ->capture_default_str();
    command
        .add_option("--max-sessions-per-address", options.crowd.sessionsPerAddress,
                    "Of those, begun from one; 0: any number")
        ->check(CLI::Range(0, kMany))
        ->capture_default_str();
}

absl::StatusOr<api::Quotas> quotasOf(const QuotaOptions& options) {
    api::Quotas quotas;
    quotas.imagePixels = options.imagePixels;
    quotas.sceneObjects = options.sceneObjects;
    ASSIGN_OR_RETURN(quotas.sceneBytes, parseBytes(options.sceneBytes, "--max-scene-bytes"));
    quotas.sceneTriangles = options.sceneTriangles;
    quotas.callsPerSecond = options.callsPerSecond;
    quotas.readers = options.readers;
    return quotas;
}

}  // namespace eyrie::cli
