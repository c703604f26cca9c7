// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>

#include <glm/geometric.hpp>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "tests/support/json.h"
#include "wire/json.h"

namespace eyrie::wire {
namespace {

using google::protobuf::util::MessageToJsonString;

std::string jsonOf(const test::JsonValue& value) {
    std::string text;
    EXPECT_TRUE(MessageToJsonString(value, &text).ok());
    return text;
}

/// data/flight.json was made in exact arithmetic; the page's tests read the same file, so both play
/// the same cameras.
TEST(FlightFile, PlaysTheCamerasThatAreWrittenBesideIt) {
    std::ifstream file(EYRIE_SOURCE_DIR "/tests/proto/fabric/data/flight.json");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const test::JsonValue document = test::parseJson(text);
    const fabric::Flight flight =
        flightFromJson(jsonOf(test::at(document, "flight")), "flight").value();
    const auto samples = test::list(document, "samples");
    ASSERT_GT(samples.size(), 10U);
    for (const test::JsonValue& sample : samples) {
        const double seconds = test::number(sample, "seconds");
        const fabric::Camera wanted =
            cameraFromJson(jsonOf(test::at(sample, "camera")), "sample").value();
        const fabric::Camera found = flight.at(seconds);
        EXPECT_LE(glm::distance(found.eye, wanted.eye), 1e-7) << seconds;
        EXPECT_LE(glm::distance(found.target, wanted.target), 1e-7) << seconds;
        EXPECT_LE(glm::distance(found.up, wanted.up), 1e-12) << seconds;
        EXPECT_NEAR(found.fovYDegrees, wanted.fovYDegrees, 1e-9) << seconds;
    }
}

}  // namespace
}  // namespace eyrie::wire
