// SPDX-License-Identifier: Apache-2.0
#include "fabric/camera_path.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/support/json.h"

namespace eyrie::fabric {
namespace {

/// The page's tests read the same file, so both read the same paths.
test::JsonValue vectors() {
    std::ifstream file(EYRIE_SOURCE_DIR "/tests/proto/fabric/data/camera_paths.json");
    return test::parseJson({std::istreambuf_iterator<char>(file), {}});
}

Vec3 vectorAt(const test::JsonValue& object, const std::string& path) {
    const auto numbers = test::list(object, path);
    EXPECT_EQ(numbers.size(), 3U) << path;
    return {numbers[0].number_value(), numbers[1].number_value(), numbers[2].number_value()};
}

std::string textAt(const test::JsonValue& object, const char* name) {
    return test::at(object, name).string_value();
}

Box boundsOf(const test::JsonValue& document) {
    return {vectorAt(document, "bounds.min"), vectorAt(document, "bounds.max")};
}

void expectKey(const FlightKey& found, const test::JsonValue& wanted) {
    const Vec3 eye = vectorAt(wanted, "eye");
    const Vec3 target = eye + vectorAt(wanted, "ahead") * test::number(wanted, "distance");
    EXPECT_NEAR(found.seconds, test::number(wanted, "seconds"), 1e-12);
    EXPECT_LE(glm::distance(found.camera.eye, eye), 1e-9);
    EXPECT_LE(glm::distance(found.camera.target, target), 1e-9);
    EXPECT_LE(glm::distance(found.camera.up, vectorAt(wanted, "up")), 1e-9);
}

TEST(CameraPath, HasTheCamerasThatAreWrittenBesideIt) {
    const test::JsonValue document = vectors();
    const double fovYDegrees = test::number(document, "fovyDegrees");
    const auto paths = test::list(document, "paths");
    ASSERT_GE(paths.size(), 8U);
    for (const test::JsonValue& wanted : paths) {
        SCOPED_TRACE(textAt(wanted, "name"));
        const auto path =
            cameraPathFromText(textAt(wanted, "text"), boundsOf(document), fovYDegrees);
        ASSERT_TRUE(path.ok()) << path.status();
        EXPECT_THAT(path->note, testing::HasSubstr(textAt(wanted, "note")));
        ASSERT_EQ(path->flight.keys.size(), test::number(wanted, "count"));
        for (const test::JsonValue& key : test::list(wanted, "keys")) {
            const auto at = static_cast<std::size_t>(test::number(key, "key"));
            expectKey(path->flight.keys.at(at), key);
            EXPECT_EQ(path->flight.keys.at(at).camera.fovYDegrees, fovYDegrees);
        }
    }
}

TEST(CameraPath, ThatIsNoneIsRefused) {
    const test::JsonValue document = vectors();
    const auto refused = test::list(document, "refused");
    ASSERT_GE(refused.size(), 10U);
    for (const test::JsonValue& wanted : refused) {
        const auto path = cameraPathFromText(textAt(wanted, "text"), boundsOf(document), 45);
        EXPECT_EQ(path.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(path.status().message()),
                    testing::HasSubstr(textAt(wanted, "says")))
            << textAt(wanted, "text");
    }
}

TEST(CameraPath, OfEqPlyGoesStraightBetweenItsSteps) {
    const Box bounds = boundsOf(vectors());
    const auto path = cameraPathFromText(
        "0 0 0\n1 0 0 -4  0 0 0\n300 1 0 -2  90 0 0\n300 5 5 5 0 0 0", bounds, 45);
    ASSERT_TRUE(path.ok()) << path.status();
    for (int i = 0; i <= 100; ++i) {
        const double share = i / 100.;
        const Camera camera = path->flight.at(10 * share);
        const Vec3 eye = bounds.centre() - 4. * Vec3(share, 0, 2 * share - 4);
        EXPECT_LE(glm::distance(camera.eye, eye), 0.01 * 9) << "a hundredth of the way";
        const double turn =
            std::atan2(camera.target.x - camera.eye.x, camera.eye.z - camera.target.z);
        EXPECT_NEAR(turn, share * std::numbers::pi / 2, 0.05) << share;
    }
}

TEST(CameraPath, OfMoreCamerasThanAreTakenIsRefused) {
    std::string lines;
    for (std::size_t i = 0; i < kMostPathKeys; ++i) lines += fmt::format("{} 0 9 0 0 1 0 1 0\n", i);
    const Box bounds{{0, 5, 8}, {1, 9, 10}};
    EXPECT_TRUE(cameraPathFromText(lines, bounds, 45).ok());
    const auto path = cameraPathFromText(lines + "0 1 9 0 0 1 0 1 0\n", bounds, 45);
    EXPECT_THAT(std::string(path.status().message()),
                testing::HasSubstr("more than 250000 cameras"));
}

}  // namespace
}  // namespace eyrie::fabric
