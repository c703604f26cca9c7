// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

#include "coordinator/api/workers.h"
#include "eyrie/v1/coordinator_service.grpc.pb.h"
#include "wire/answer_limit.h"
#include "wire/security.h"

namespace eyrie::api {

class Handlers;

/// CoordinatorService over gRPC. Calls are done by threads of its own; one that is cancelled, or
/// whose deadline passes, tells its handler. Who does not take its answer is cancelled.
class CoordinatorService final : public v1::CoordinatorService::CallbackService {
public:
    /// `patience`: wire::AnswerLimit's.
    explicit CoordinatorService(const wire::Security& security = {},
                                std::chrono::milliseconds patience = wire::AnswerLimit::kPatience)
        : security_(security), patience_(patience) {}

    /// From now on calls are answered; Unavailable before. `handlers` outlive stop(). Any thread.
    void use(const Handlers& handlers) { handlers_ = &handlers; }

    /// From now on no more calls are taken (Unavailable); those in progress go on. Any thread.
    void drain() { isDraining_ = true; }

    /// Waits for the calls in progress. Once the server takes no more.
    void stop() { workers_.stop(); }

#define EYRIE_CALL(NAME)                                                                         \
    grpc::ServerUnaryReactor* NAME(grpc::CallbackServerContext* context,                         \
                                   const v1::NAME##Request* request, v1::NAME##Response* answer) \
        override {                                                                               \
        return call(#NAME, *context, *request, *answer);                                         \
    }
    EYRIE_CALL(GetStatus)
    EYRIE_CALL(GetScene)
    EYRIE_CALL(SetScene)
    EYRIE_CALL(RenderImage)
    EYRIE_CALL(PickPoint)
    EYRIE_CALL(MeasureProfile)
    EYRIE_CALL(GetConfiguration)
    EYRIE_CALL(ChangeConfiguration)
    EYRIE_CALL(ListSessions)
    EYRIE_CALL(GetSession)
    EYRIE_CALL(ChangeSession)
    EYRIE_CALL(CloseSession)
    EYRIE_CALL(GetTrace)
    EYRIE_CALL(ListFlights)
    EYRIE_CALL(GetFlight)
    EYRIE_CALL(PutFlight)
    EYRIE_CALL(DeleteFlight)
    EYRIE_CALL(ListDataSets)
    EYRIE_CALL(Import)
    EYRIE_CALL(Bench)
    EYRIE_CALL(GetReport)
    EYRIE_CALL(ListOperations)
    EYRIE_CALL(GetOperation)
    EYRIE_CALL(CancelOperation)
    EYRIE_CALL(DeleteOperation)
#undef EYRIE_CALL

    grpc::ServerWriteReactor<v1::WatchStatisticsResponse>* WatchStatistics(
        grpc::CallbackServerContext* context, const v1::WatchStatisticsRequest* request) override;

private:
    grpc::ServerUnaryReactor* call(const char* name, grpc::CallbackServerContext& context,
                                   const google::protobuf::Message& request,
                                   google::protobuf::Message& answer);

    /// Whether a call may be made at all. Errors: those of admit(), Unavailable before use() and
    /// after drain(), ResourceExhausted.
    absl::Status admit(const char* name, const grpc::CallbackServerContext& context) const;

    const wire::Security security_;
    const std::chrono::milliseconds patience_;

    std::atomic<const Handlers*> handlers_ = nullptr;
    std::atomic<bool> isDraining_ = false;
    Workers workers_{8, 64};
};

}  // namespace eyrie::api
