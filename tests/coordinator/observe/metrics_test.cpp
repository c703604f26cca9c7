// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/metrics.h"

#include <limits>
#include <regex>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access/gate.h"
#include "tests/support/json.h"
#include "tests/support/source_text.h"

namespace eyrie::observe {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::string scraped(Metrics& metrics) {
    return metrics.text({{"ready", 2}, {"dead", 0}}, {{"10.0.0.7:5000", "renderer-3"}});
}

/// Of everything that can be scraped: "eyrie_frames_total" and so on.
std::set<std::string> families() {
    Metrics metrics;
    metrics.rendererHolds("10.0.0.7:5000", 1, 2);
    const std::string text = scraped(metrics);
    const std::regex type("# TYPE (\\w+) ");
    std::set<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), type), end; at != end; ++at)
        names.insert((*at)[1]);
    return names;
}

void collectQueries(const test::JsonValue& value, std::vector<std::string>& queries) {
    for (const auto& [name, field] : value.struct_value().fields()) {
        if (name == "expr")
            queries.push_back(field.string_value());
        collectQueries(field, queries);
    }
    for (const auto& element : value.list_value().values()) collectQueries(element, queries);
}

TEST(Metrics, CountsFramesByWhatBecameOfThem) {
    Metrics metrics;
    fabric::FrameStatistics statistics;
    statistics.tauAchievedPixels = 0.75;
    statistics.triangles = 1000;
    statistics.points = 30;
    metrics.frameMade(statistics);
    statistics.complete = false;
    statistics.pagesMissing = 3;
    metrics.frameMade(statistics);
    metrics.frameFailed();
    metrics.frameCancelled();
    const std::string text = scraped(metrics);
    EXPECT_THAT(text, HasSubstr("eyrie_frames_total{result=\"complete\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_frames_total{result=\"degraded\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_frames_total{result=\"failed\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_frames_total{result=\"cancelled\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_frame_error_pixels_bucket{le=\"0.5\"} 0\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_frame_error_pixels_bucket{le=\"1\"} 2\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_triangles_total 2000\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_points_total 60\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_pages_missing 3\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_renderers{condition=\"ready\"} 2\n"));
}

TEST(Metrics, KeepsAnInfiniteErrorOutOfTheSum) {
    Metrics metrics;
    fabric::FrameStatistics statistics;
    statistics.tauAchievedPixels = std::numeric_limits<double>::infinity();
    metrics.frameMade(statistics);
    EXPECT_THAT(scraped(metrics), HasSubstr("eyrie_frames_unbounded_total 1\n"));
    EXPECT_THAT(scraped(metrics), HasSubstr("eyrie_frame_error_pixels_sum 0\n"));
}

TEST(Metrics, TellsRefusalsApart) {
    Metrics metrics;
    for (const int status : {200, 403, 404, 404, 418}) metrics.refused(status);
    const std::string text = scraped(metrics);
    EXPECT_THAT(text, HasSubstr("eyrie_requests_refused_total{reason=\"forbidden\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_requests_refused_total{reason=\"not_found\"} 2\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_requests_refused_total{reason=\"other\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_requests_refused_total{reason=\"rate\"} 0\n"));
}

TEST(Metrics, TellsCallsAndOperationsByTheirEnds) {
    Metrics metrics;
    for (const absl::StatusCode code :
         {absl::StatusCode::kOk, absl::StatusCode::kNotFound, absl::StatusCode::kNotFound})
        metrics.callFailed(code);
    metrics.operationEnded(absl::OkStatus());
    metrics.operationEnded(absl::DataLossError(""));
    metrics.operationEnded(absl::CancelledError(""));
    metrics.operationEnded(absl::UnavailableError(""));
    const std::string text = scraped(metrics);
    EXPECT_THAT(text, HasSubstr("eyrie_calls_failed_total{code=\"NOT_FOUND\"} 2\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_calls_failed_total{code=\"UNAVAILABLE\"} 0\n"));
    EXPECT_THAT(text, Not(HasSubstr("code=\"OK\"")));
    EXPECT_THAT(text, HasSubstr("eyrie_operations_total{result=\"done\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_operations_total{result=\"failed\"} 2\n"));
    EXPECT_THAT(text, HasSubstr("eyrie_operations_total{result=\"cancelled\"} 1\n"));
}

TEST(Metrics, TellsWhoWasTurnedAwayAtWhichDoor) {
    Metrics metrics;
    access::Refusals refusals{7, 5, 2, 1, 3};
    metrics.turnedAway(access::Door::Grpc, refusals);
    refusals.handshakes = 4;
    metrics.turnedAway(access::Door::Grpc, refusals);                           // so far
    for (int i = 0; i < 2; ++i) metrics.turnedAwayByRenderer({1, 3, 1, 0, 5});  // since then
    metrics.handshakeFailed();
    const std::string text = scraped(metrics);
    const auto expectCount = [&](const std::string& door, const std::string& reason, int count) {
        EXPECT_THAT(text, HasSubstr("eyrie_peers_refused_total{door=\"" + door + "\",reason=\"" +
                                    reason + "\"} " + std::to_string(count) + "\n"));
    };
    expectCount("grpc", "no_token", 7);
    expectCount("grpc", "wrong_token", 3);
    expectCount("grpc", "too_many_wrong", 2);
    expectCount("grpc", "forbidden", 1);
    expectCount("grpc", "handshake", 4);
    expectCount("renderer", "no_token", 2);
    expectCount("renderer", "wrong_token", 4);
    expectCount("renderer", "too_many_wrong", 2);
    expectCount("renderer", "forbidden", 0);
    expectCount("renderer", "handshake", 10);
    expectCount("http", "no_token", 0);
    expectCount("http", "handshake", 1);
}

TEST(Metrics, ForgetsRenderersThatAreGone) {
    Metrics metrics;
    const std::string other = "unix:/tmp/e/renderer-1-1";
    metrics.rendererHolds("10.0.0.7:5000", 10, 20);
    metrics.rendererHolds(other, 30, 40);
    EXPECT_THAT(scraped(metrics), HasSubstr("memory=\"device\",renderer=\"renderer-3\"} 10\n"));
    EXPECT_THAT(scraped(metrics), Not(HasSubstr("\"host\",renderer=\"renderer-4\"")));
    EXPECT_THAT(metrics.text({}, {{other, "renderer-4"}}), Not(HasSubstr("renderer="))) << "forgot";
    metrics.rendererHolds(other, 50, 60);
    EXPECT_THAT(metrics.text({}, {{other, "renderer-4"}}),
                HasSubstr("memory=\"host\",renderer=\"renderer-4\"} 60\n"));
}

TEST(Metrics, RenderersThatRegisterAnewAreToldUnderTheirNewIdsAlone) {
    Metrics metrics;
    metrics.rendererHolds("10.0.0.7:5000", 10, 20);
    EXPECT_THAT(scraped(metrics), HasSubstr("renderer=\"renderer-3\""));
    const std::string text = metrics.text({}, {{"10.0.0.7:5000", "renderer-5"}});
    EXPECT_THAT(text, HasSubstr("memory=\"host\",renderer=\"renderer-5\"} 20\n"));
    EXPECT_THAT(text, Not(HasSubstr("renderer-3")));
}

TEST(Metrics, EachHasAPlaceInTheDocumentation) {
    const std::string documentation = test::sourceText("docs/operations.md");
    for (const std::string& name : families())
        EXPECT_THAT(documentation, HasSubstr("`" + name + "`"));
    for (int stage = 0; stage <= static_cast<int>(kLastStage); ++stage)
        EXPECT_THAT(documentation,
                    HasSubstr("`" + std::string(nameOf(static_cast<Stage>(stage))) + "`"));
}

TEST(Metrics, TheDashboardAsksForNothingElse) {
    std::vector<std::string> queries;
    collectQueries(test::parseJson(test::sourceText("deploy/grafana/eyrie.json")), queries);
    ASSERT_GT(queries.size(), 8u);
    const std::set<std::string> known = families();
    const std::regex word("\\b(?:eyrie|process)_\\w+");
    for (const std::string& query : queries) {
        int names = 0;
        for (std::sregex_iterator at(query.begin(), query.end(), word), end; at != end; ++at) {
            const std::string series = at->str();
            const std::string family =
                std::regex_replace(series, std::regex("_(bucket|sum|count)$"), "");
            EXPECT_TRUE(known.contains(series) || known.contains(family)) << query;
            ++names;
        }
        EXPECT_GT(names, 0) << query;
    }
}

}  // namespace
}  // namespace eyrie::observe
