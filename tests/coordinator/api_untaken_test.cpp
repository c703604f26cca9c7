// SPDX-License-Identifier: Apache-2.0
// Answers that nobody takes hold what there is for all for a while only.
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>

#include "tests/coordinator/api_fixture.h"
#include "tests/service/eventually.h"

namespace eyrie::api {
namespace {

using testing::HasSubstr;

/// Holds as little of an answer as it may that nobody has read.
std::shared_ptr<grpc::Channel> narrowChannel(const std::string& address) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 4096);
    return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

/// A call that is made, and its answer never read.
class Untaken {
public:
    Untaken(const std::string& address, const std::string& name,
            const google::protobuf::Message& request)
        : stub_(narrowChannel(address)),
          call_(stub_.PrepareCall(&context_, "/eyrie.v1.CoordinatorService/" + name, &queue_)) {
        call_->StartCall(nullptr);
        awaitTag();
        const grpc::Slice bytes(request.SerializeAsString());
        call_->WriteLast(grpc::ByteBuffer(&bytes, 1), {}, nullptr);
        awaitTag();
    }
    ~Untaken() {
        context_.TryCancel();
        queue_.Shutdown();
    }
    Untaken(const Untaken&) = delete;
    Untaken& operator=(const Untaken&) = delete;

    /// Until the answer has begun to come.
    void awaitAnswer() {
        call_->ReadInitialMetadata(nullptr);
        awaitTag();
    }

private:
    void awaitTag() {
        void* tag = nullptr;
        bool isGood = false;
        EXPECT_TRUE(queue_.Next(&tag, &isGood) && isGood);
    }

    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    grpc::CompletionQueue queue_;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

class ApiUntaken : public BothDoors {
protected:
    void makeApiOfShortPatience(const Quotas& quotas) {
        patience_ = std::chrono::milliseconds(1500);
        makeApi(quotas);
    }
    Untaken makeUntaken(const std::string& name, const google::protobuf::Message& request) const {
        return {"unix:" + folder_.path("s"), name, request};
    }
};

TEST_F(ApiUntaken, PicturesKeepTheirShareForAWhile) {
    makeApiOfShortPatience({.imagePixels = 160'000});
    v1::RenderImageRequest request;
    request.set_width(400);
    request.set_height(400);
    request.set_format(v1::IMAGE_FORMAT_RAW);
    Untaken one = makeUntaken("RenderImage", request);
    Untaken two = makeUntaken("RenderImage", request);
    one.awaitAnswer();
    two.awaitAnswer();
    const auto answer = [&] { return ask("GET", "/image?width=10&height=10").status; };
    EXPECT_EQ(answer(), 429);
    EXPECT_TRUE(eventually([&] { return answer() == 200; }));
}

TEST_F(ApiUntaken, StatisticsKeepTheirSeatForAWhile) {
    makeApiOfShortPatience({.readers = 1});
    const Untaken one = makeUntaken("WatchStatistics", v1::WatchStatisticsRequest());
    const auto answer = [&] {
        EXPECT_EQ(ask("GET", "/image?width=1&height=1").status, 200);
        return ask("GET", "/statistics").status;
    };
    ASSERT_TRUE(eventually([&] { return answer() == 429; }));
    EXPECT_TRUE(eventually([&] { return answer() == 200; }));
}

TEST_F(ApiUntaken, ReportsHaveAShareOfTheirBytes) {
    makeApiOfShortPatience({.documentBytes = 1 << 20});
    std::filesystem::create_directory(data() / "one.bench");
    std::ofstream(data() / "one.bench" / "summary.json") << std::string(1 << 20, ' ');
    v1::GetReportRequest request;
    request.set_name("one.bench");
    Untaken one = makeUntaken("GetReport", request);
    one.awaitAnswer();
    const auto answer = [&](const char* target) { return ask("GET", target); };
    EXPECT_EQ(answer("/reports/one.bench").status, 429);
    EXPECT_THAT(*answer("/trace").body, HasSubstr("too many large reports or traces"));
    EXPECT_GE(refusals("documents"), 2);
    EXPECT_TRUE(eventually([&] { return answer("/reports/one.bench").status == 200; }));
    const RestAnswer held = answer("/reports/one.bench");
    EXPECT_EQ(answer("/trace").status, 429) << "by HTTP, too, until it has been sent";
}

}  // namespace
}  // namespace eyrie::api
