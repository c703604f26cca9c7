// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include "access/gate.h"
#include "coordinator/observe/process_figures.h"
#include "fabric/version.h"

namespace eyrie::observe {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

const Histogram::BucketBoundaries kSeconds = {0.001, 0.002, 0.005, 0.01, 0.016, 0.025, 0.033,
                                              0.05,  0.1,   0.2,   0.5,  1,     2,     5};
const Histogram::BucketBoundaries kPixels = {0.25, 0.5, 1, 1.5, 2, 4, 8, 16, 32, 64};

/// Reasons by HTTP status; what is not listed counts as "other".
constexpr std::array<std::pair<int, std::string_view>, 13> kReasons = {{
    {400, "malformed"},
    {401, "unauthenticated"},
    {403, "forbidden"},
    {404, "not_found"},
    {405, "method"},
    {408, "too_slow"},
    {412, "precondition"},
    {413, "body_too_large"},
    {426, "not_a_websocket"},
    {429, "rate"},
    {431, "header_too_large"},
    {500, "failed"},
    {503, "unavailable"},
}};
constexpr std::string_view kOther = "other";

/// What handlers answer with.
constexpr std::array kErrors = {
    absl::StatusCode::kCancelled,          absl::StatusCode::kInvalidArgument,
    absl::StatusCode::kDeadlineExceeded,   absl::StatusCode::kNotFound,
    absl::StatusCode::kAlreadyExists,      absl::StatusCode::kPermissionDenied,
    absl::StatusCode::kFailedPrecondition, absl::StatusCode::kResourceExhausted,
    absl::StatusCode::kUnimplemented,      absl::StatusCode::kInternal,
    absl::StatusCode::kUnavailable,        absl::StatusCode::kDataLoss};

std::string nameOf(absl::StatusCode code) { return absl::StatusCodeToString(code); }

std::string reasonOf(int status) {
    for (const auto& [known, reason] : kReasons)
        if (known == status)
            return std::string(reason);
    return std::string(kOther);
}

std::string nameOf(Peer peer) {
    return peer == Peer::Http ? "http" : peer == Peer::WebSocket ? "websocket" : "renderer";
}

}  // namespace

std::string_view nameOf(Stage stage) {
    switch (stage) {
        case Stage::Turn:
            return "turn";
        case Stage::Plan:
            return "plan";
        case Stage::Render:
            return "render";
        case Stage::Compose:
            return "compose";
        case Stage::Total:
            return "total";
        case Stage::Cull:
            return "cull";
        case Stage::Draw:
            return "draw";
        case Stage::Readback:
            return "readback";
        case Stage::Receive:
            return "receive";
        case Stage::Encode:
            return "encode";
        case Stage::Send:
            return "send";
    }
    return "";
}

std::string_view nameOf(Quota quota) {
    switch (quota) {
        case Quota::Image:
            return "image";
        case Quota::Scene:
            return "scene";
        case Quota::Rate:
            return "rate";
        case Quota::Viewers:
            return "viewers";
        case Quota::Readers:
            return "readers";
        case Quota::Operations:
            return "operations";
        case Quota::Documents:
            return "documents";
    }
    return "";
}

class Metrics::Impl {
public:
    Impl() {
        for (int quota = 0; quota <= static_cast<int>(kLastQuota); ++quota)
            overQuota_.Add({{"quota", std::string(nameOf(static_cast<Quota>(quota)))}});
        for (int stage = 0; stage <= static_cast<int>(kLastStage); ++stage)
            byStage_.push_back(&stages_.Add(
                {{"stage", std::string(nameOf(static_cast<Stage>(stage)))}}, kSeconds));
        for (const absl::StatusCode code : kErrors) callsFailed_.Add({{"code", nameOf(code)}});
        for (const auto& [status, reason] : kReasons)
            refused_.Add({{"reason", std::string(reason)}});
        refused_.Add({{"reason", std::string(kOther)}});
        for (const access::Door door : {access::Door::Http, access::Door::Grpc})
            turnedAway(door, {});
        turnedAwayByRenderer({});
        for (const Peer peer : {Peer::Http, Peer::WebSocket, Peer::Renderer}) {
            received_.Add({{"peer", nameOf(peer)}});
            if (peer != Peer::Renderer)  // what it is sent is small, and not counted
                sent_.Add({{"peer", nameOf(peer)}});
        }
        family(&prometheus::BuildGauge, "eyrie_build_info", "Which Eyrie this is; always 1.")
            .Add({{"version", std::string(fabric::kVersion)}})
            .Set(1);
        startTime_.SetToCurrentTime();
    }

    void frameMade(const fabric::FrameStatistics& statistics) {
        (statistics.complete ? complete_ : degraded_).Increment();
        if (std::isfinite(statistics.tauAchievedPixels))
            error_.Observe(statistics.tauAchievedPixels);
        else
            unbounded_.Increment();
        triangles_.Increment(static_cast<double>(statistics.triangles));
        points_.Increment(static_cast<double>(statistics.points));
        pages_.Increment(static_cast<double>(statistics.pagesLoaded));
        pageBytes_.Increment(static_cast<double>(statistics.bytesLoaded));
        missing_.Set(static_cast<double>(statistics.pagesMissing));
        unreadable_.Set(static_cast<double>(statistics.pagesFailed));
        const fabric::StageMilliseconds& ms = statistics.milliseconds;
        took(Stage::Cull, std::chrono::duration<double, std::milli>(ms.cull));
        took(Stage::Draw, std::chrono::duration<double, std::milli>(ms.draw));
        took(Stage::Readback, std::chrono::duration<double, std::milli>(ms.readback));
    }

    void frameFailed() { failed_.Increment(); }
    void frameCancelled() { cancelled_.Increment(); }

    void took(Stage stage, std::chrono::duration<double> time) {
        byStage_[static_cast<std::size_t>(stage)]->Observe(time.count());
    }

    void bytes(Peer peer, Direction direction, std::size_t count) {
        (direction == Direction::In ? received_ : sent_)
            .Add({{"peer", nameOf(peer)}})
            .Increment(static_cast<double>(count));
    }

    void pictureCame(bool inMemory) { (inMemory ? inMemory_ : inMessages_).Increment(); }
    void viewers(int change) { viewers_.Increment(change); }
    void swapped(int together, int cutShort) {
        together_.Increment(together);
        cutShort_.Increment(cutShort);
    }
    void taskReissued(bool wasLate) { (wasLate ? late_ : afterFailure_).Increment(); }
    void overQuota(Quota quota) {
        overQuota_.Add({{"quota", std::string(nameOf(quota))}}).Increment();
    }
    void callFailed(absl::StatusCode code) {
        if (code != absl::StatusCode::kOk)
            callsFailed_.Add({{"code", nameOf(code)}}).Increment();
    }
    void operationEnded(const absl::Status& status) {
        (status.ok()                 ? operationsDone_
         : absl::IsCancelled(status) ? operationsCancelled_
                                     : operationsFailed_)
            .Increment();
    }
    void refused(int status) {
        if (status >= 400)
            refused_.Add({{"reason", reasonOf(status)}}).Increment();
    }

    void turnedAway(access::Door door, const access::Refusals& soFar) {
        forEachReason(door == access::Door::Http ? "http" : "grpc", soFar,
                      [](Counter& counter, double count) {
                          counter.Increment(std::max(0.0, count - counter.Value()));
                      });
    }
    void turnedAwayByRenderer(const access::Refusals& since) {
        forEachReason("renderer", since,
                      [](Counter& counter, double count) { counter.Increment(count); });
    }
    void handshakeFailed() { handshakes_.Increment(); }

    void rendererHolds(const std::string& address, std::uint64_t deviceBytes,
                       std::uint64_t hostBytes) {
        const std::lock_guard lock(heldMutex_);
        Held& held = held_[address];
        held.deviceBytes = deviceBytes;
        held.hostBytes = hostBytes;
    }

    std::string text(const std::map<std::string, int>& renderers,
                     const std::map<std::string, std::string>& ids) {
        for (const auto& [condition, count] : renderers)
            renderers_.Add({{"condition", condition}}).Set(count);
        tellHeld(ids);
        const ProcessFigures figures = processFigures();
        cpu_.Increment(std::max(0.0, figures.cpuSeconds - cpu_.Value()));
        resident_.Set(static_cast<double>(figures.residentBytes));
        virtual_.Set(static_cast<double>(figures.virtualBytes));
        files_.Set(static_cast<double>(figures.openFiles));
        threads_.Set(static_cast<double>(figures.threads));
        return prometheus::TextSerializer().Serialize(registry_.Collect());
    }

private:
    struct Held {
        std::uint64_t deviceBytes = 0;
        std::uint64_t hostBytes = 0;
        std::string id = {};  ///< that it is told under; empty: it is not yet
        Gauge* device = nullptr;
        Gauge* host = nullptr;
    };

    template <typename Builder>
    auto family(Builder (*build)(), const char* name, const char* help)
        -> decltype(build().Register(std::declval<prometheus::Registry&>())) {
        return build().Name(name).Help(help).Register(registry_);
    }
    Family<Counter>& counters(const char* name, const char* help) {
        return family(&prometheus::BuildCounter, name, help);
    }
    Counter& counter(const char* name, const char* help) { return counters(name, help).Add({}); }
    Family<Gauge>& gauges(const char* name, const char* help) {
        return family(&prometheus::BuildGauge, name, help);
    }
    Gauge& gauge(const char* name, const char* help) { return gauges(name, help).Add({}); }
    Family<Histogram>& histograms(const char* name, const char* help) {
        return family(&prometheus::BuildHistogram, name, help);
    }

    /// `take` gets the counter of each reason and how often it is in `refusals`.
    template <typename Take>
    void forEachReason(const char* door, const access::Refusals& refusals, Take take) {
        for (const auto& [reason, count] :
             {std::pair("no_token", refusals.missing),
              std::pair("wrong_token", refusals.wrong - refusals.limited),
              std::pair("too_many_wrong", refusals.limited),
              std::pair("forbidden", refusals.forbidden),
              std::pair("handshake", refusals.handshakes)})
            take(peersRefused_.Add({{"door", door}, {"reason", reason}}),
                 static_cast<double>(count));
    }

    void tellHeld(const std::map<std::string, std::string>& ids) {
        const std::lock_guard lock(heldMutex_);
        for (auto at = held_.begin(); at != held_.end();) {
            const auto found = ids.find(at->first);
            tell(at->second, found != ids.end() ? found->second : "");
            at = found != ids.end() ? std::next(at) : held_.erase(at);
        }
    }

    /// Under `id`; under none where that is empty.
    void tell(Held& held, const std::string& id) {
        if (held.id != id) {
            if (!held.id.empty()) {
                memory_.Remove(held.device);
                memory_.Remove(held.host);
            }
            held.id = id;
            if (!id.empty()) {
                held.device = &memory_.Add({{"renderer", id}, {"memory", "device"}});
                held.host = &memory_.Add({{"renderer", id}, {"memory", "host"}});
            }
        }
        if (id.empty())
            return;
        held.device->Set(static_cast<double>(held.deviceBytes));
        held.host->Set(static_cast<double>(held.hostBytes));
    }

    prometheus::Registry registry_;
    Family<Counter>& frames_ =
        counters("eyrie_frames_total",
                 "Frames that browsers and programs asked for, once each however many renderers, "
                 "views or eyes: complete, degraded (drawn, but data were missing), failed, or "
                 "cancelled (who had asked went away).");
    Counter& complete_ = frames_.Add({{"result", "complete"}});
    Counter& degraded_ = frames_.Add({{"result", "degraded"}});
    Counter& failed_ = frames_.Add({{"result", "failed"}});
    Counter& cancelled_ = frames_.Add({{"result", "cancelled"}});
    Family<Histogram>& stages_ = histograms(
        "eyrie_frame_stage_seconds",
        "Where the time of frames goes, by stage; those of channels and browsers once for each.");
    std::vector<Histogram*> byStage_;
    Histogram& error_ =
        histograms("eyrie_frame_error_pixels",
                   "Screen-space error promised with each complete or degraded frame; "
                   "those without a finite one are not in it.")
            .Add({}, kPixels);
    Counter& unbounded_ =
        counter("eyrie_frames_unbounded_total",
                "Complete or degraded frames without a finite bound on their error.");
    Counter& triangles_ =
        counter("eyrie_triangles_total", "Triangles drawn for complete and degraded frames.");
    Counter& points_ =
        counter("eyrie_points_total", "Points drawn for the same frames, in place of triangles.");
    Counter& pages_ =
        counter("eyrie_pages_loaded_total", "Pages that renderers loaded, as told with frames.");
    Counter& pageBytes_ = counter("eyrie_page_bytes_loaded_total",
                                  "Bytes of the pages that renderers loaded, as stored.");
    Gauge& missing_ = gauge("eyrie_pages_missing",
                            "Pages that the last frame needed and renderers were yet loading.");
    Gauge& unreadable_ = gauge("eyrie_pages_unreadable",
                               "Pages that the last frame needed and that could not be read.");
    Family<Counter>& received_ = counters(
        "eyrie_received_bytes_total",
        "Bytes received, as they are before encryption: HTTP with its headers, WebSockets' "
        "messages, and the pixels in renderers' messages as coded.");
    Family<Counter>& sent_ =
        counters("eyrie_sent_bytes_total",
                 "Bytes sent, as they are before encryption, by HTTP with its headers and in "
                 "WebSockets' messages.");
    Family<Counter>& pictures_ =
        counters("eyrie_renderer_pictures_total",
                 "Pictures of channels from renderers: in memory of this machine, or in messages.");
    Counter& inMemory_ = pictures_.Add({{"way", "memory"}});
    Counter& inMessages_ = pictures_.Add({{"way", "messages"}});
    Gauge& viewers_ = gauge("eyrie_viewers", "Browsers that are connected.");
    Family<Counter>& swaps_ =
        counters("eyrie_swaps_total", "Pictures that screens behind a swap barrier have shown.");
    Counter& together_ = swaps_.Add({{"result", "together"}});
    Counter& cutShort_ = swaps_.Add({{"result", "without_late"}});
    Family<Gauge>& renderers_ = gauges("eyrie_renderers", "Renderers by their condition.");
    Family<Counter>& reissued_ =
        counters("eyrie_tasks_reissued_total", "Channel tasks given to another renderer as well.");
    Counter& late_ = reissued_.Add({{"reason", "late"}});
    Counter& afterFailure_ = reissued_.Add({{"reason", "failed"}});
    Family<Gauge>& memory_ =
        gauges("eyrie_renderer_memory_bytes",
               "What a renderer's caches and terrains' indices hold, as of its last channel.");
    Family<Counter>& refused_ = counters(
        "eyrie_requests_refused_total",
        "HTTP requests answered with 400 or more, and answers that were not taken in time.");
    Family<Counter>& peersRefused_ =
        counters("eyrie_peers_refused_total", "Peers turned away, by door and reason.");
    Counter& handshakes_ = peersRefused_.Add({{"door", "http"}, {"reason", "handshake"}});
    Family<Counter>& overQuota_ =
        counters("eyrie_over_quota_total", "Calls and viewers refused as they ask for too much.");
    Family<Counter>& callsFailed_ =
        counters("eyrie_calls_failed_total", "Calls of the API that were answered with an error.");
    Family<Counter>& operations_ =
        counters("eyrie_operations_total", "Imports and bench runs that have ended.");
    Counter& operationsDone_ = operations_.Add({{"result", "done"}});
    Counter& operationsFailed_ = operations_.Add({{"result", "failed"}});
    Counter& operationsCancelled_ = operations_.Add({{"result", "cancelled"}});
    Counter& cpu_ = counter("process_cpu_seconds_total", "User and system time of this process.");
    Gauge& resident_ = gauge("process_resident_memory_bytes", "Memory in use by this process.");
    Gauge& virtual_ = gauge("process_virtual_memory_bytes", "Address space of this process.");
    Gauge& files_ = gauge("process_open_fds", "Open file descriptors of this process.");
    Gauge& threads_ = gauge("process_threads", "Threads of this process.");
    Gauge& startTime_ = gauge("process_start_time_seconds", "When this process began, since 1970.");

    std::mutex heldMutex_;              ///< guards held_
    std::map<std::string, Held> held_;  ///< by address
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {}
Metrics::~Metrics() = default;

void Metrics::frameMade(const fabric::FrameStatistics& statistics) { impl_->frameMade(statistics); }
void Metrics::frameFailed() { impl_->frameFailed(); }
void Metrics::frameCancelled() { impl_->frameCancelled(); }
void Metrics::took(Stage stage, std::chrono::duration<double> time) { impl_->took(stage, time); }
void Metrics::bytes(Peer peer, Direction direction, std::size_t count) {
    impl_->bytes(peer, direction, count);
}
void Metrics::pictureCame(bool inMemory) { impl_->pictureCame(inMemory); }
void Metrics::viewers(int change) { impl_->viewers(change); }
void Metrics::swapped(int together, int cutShort) { impl_->swapped(together, cutShort); }
void Metrics::taskReissued(bool wasLate) { impl_->taskReissued(wasLate); }
void Metrics::overQuota(Quota quota) { impl_->overQuota(quota); }
void Metrics::callFailed(absl::StatusCode code) { impl_->callFailed(code); }
void Metrics::operationEnded(const absl::Status& status) { impl_->operationEnded(status); }
void Metrics::refused(int status) { impl_->refused(status); }
void Metrics::turnedAway(access::Door door, const access::Refusals& soFar) {
    impl_->turnedAway(door, soFar);
}
void Metrics::turnedAwayByRenderer(const access::Refusals& since) {
    impl_->turnedAwayByRenderer(since);
}
void Metrics::handshakeFailed() { impl_->handshakeFailed(); }
void Metrics::rendererHolds(const std::string& address, std::uint64_t deviceBytes,
                            std::uint64_t hostBytes) {
    impl_->rendererHolds(address, deviceBytes, hostBytes);
}
std::string Metrics::text(const std::map<std::string, int>& renderers,
                          const std::map<std::string, std::string>& ids) {
    return impl_->text(renderers, ids);
}

}  // namespace eyrie::observe
