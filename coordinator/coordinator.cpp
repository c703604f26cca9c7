// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "access/printable.h"
#include "coordinator/api/api.h"
#include "coordinator/api/grpc_service.h"
#include "coordinator/api/state_file.h"
#include "coordinator/farm/registry.h"
#include "coordinator/frame/frame_pipeline.h"
#include "fabric/status.h"
#include "wire/picture_heap.h"

namespace eyrie::coordinator {
namespace {

/// Gives renderers up whose heartbeats stop, and asks those again that could not open the scene.
void watchRenderers(Registry& registry, FramePipeline& pipeline, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
        wake.wait_for(lock, stop, registry.options().heartbeatInterval / 4, [] { return false; });
        const Registry::Clock::time_point now = Registry::Clock::now();
        registry.expire(now);
        pipeline.openAgain(now);
    }
}

}  // namespace

class Coordinator::Impl {
public:
    Impl(observe::SharedTelemetry telemetry, std::unique_ptr<Registry> registry,
         std::unique_ptr<GrpcService> door, std::optional<access::DataFolder> dataFolder,
         const CoordinatorOptions& options)
        : telemetry_(std::move(telemetry)),
          registry_(std::move(registry)),
          state_(dataFolder
                     ? std::make_unique<api::StateFile>(*dataFolder, options.configurationFile)
                     : nullptr),
          pipeline_(*registry_, pipelineOptions(options, *door, telemetry_, state_.get())),
          api_({pipeline_, pipeline_,
                [this](fabric::Scene scene) { pipeline_.setScene(std::move(scene)); },
                std::move(dataFolder), options.programs, options.quotas, telemetry_, state_.get()}),
          door_(std::move(door)),
          watcher_([this](const std::stop_token& stop) {
              watchRenderers(*registry_, pipeline_, stop);
          }) {
        if (!options.scene.objects.empty())
            setScene(options.scene, options.scene);
        door_->use(api_.handlers());
    }

    FramePipeline& frames() { return pipeline_; }
    const GrpcService& door() const { return *door_; }
    const api::Api& api() const { return api_; }
    void setScene(fabric::Scene scene, fabric::Scene asNamed) {
        api_.begin(std::move(scene), std::move(asNamed));
    }
    const observe::SharedTelemetry& telemetry() const { return telemetry_; }
    void drain() {
        api_.endStreams();
        door_->drain();
    }

    void stop() {
        drain();
        door_->stop();
    }

    void abandonFrames() {
        cancelFrames();  // what stop() may be waiting for
        stop();
        cancelFrames();  // of renderers that came meanwhile
    }

private:
    void cancelFrames() {
        for (const Registry::Entry& entry : registry_->entries())
            if (entry.renderer)
                entry.renderer->cancel();
    }

    static FramePipelineOptions pipelineOptions(const CoordinatorOptions& options,
                                                const GrpcService& door,
                                                observe::SharedTelemetry telemetry,
                                                api::StateFile* state) {
        FramePipelineOptions pipeline;
        pipeline.telemetry = std::move(telemetry);
        pipeline.configuration = options.configuration;
        pipeline.layout = options.layout;
        if (state != nullptr)
            pipeline.keeping = {
                state->configuration(),
                [state](const KeptConfiguration& configuration) { state->keep(configuration); }};
        pipeline.howToJoin =
            options.startsRenderers
                ? ""
                : fmt::format("eyrie renderer --coordinator {}", door.addresses().back());
        return pipeline;
    }

    const observe::SharedTelemetry telemetry_;
    const std::unique_ptr<Registry> registry_;
    const std::unique_ptr<api::StateFile> state_;  ///< null without a data folder
    FramePipeline pipeline_;
    api::Api api_;
    const std::unique_ptr<GrpcService> door_;
    std::jthread watcher_;
};

namespace {

/// Whether renderers can be told of it: messages have text in UTF-8 only.
absl::Status check(const fabric::Scene& scene) {
    RETURN_IF_ERROR(fabric::validate(scene));
    for (const fabric::SceneObject& object : scene.objects)
        for (const std::string& text : {object.path, object.name})
            if (!access::isUtf8(text))
                return absl::InvalidArgumentError(
                    fmt::format("{} is not UTF-8; rename the file", access::printable(text)));
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Coordinator>> Coordinator::start(const CoordinatorOptions& options) {
    RETURN_IF_ERROR(check(options.scene));
    if (options.grpcAddresses.empty())
        return absl::InvalidArgumentError(
            "the coordinator has no address for renderers to register at");
    wire::keepPictureHeap();
    std::optional<access::DataFolder> dataFolder;
    if (!options.dataFolder.empty()) {
        ASSIGN_OR_RETURN(dataFolder, access::DataFolder::open(options.dataFolder));
    }
    auto registry = std::make_unique<Registry>();
    auto telemetry = std::make_shared<observe::Telemetry>();
    ASSIGN_OR_RETURN(std::unique_ptr<GrpcService> door,
                     GrpcService::start(options.grpcAddresses, *registry,
                                        {options.security, options.grpcReflection, telemetry}));
    return std::unique_ptr<Coordinator>(
        new Coordinator(std::make_unique<Impl>(std::move(telemetry), std::move(registry),
                                               std::move(door), std::move(dataFolder), options)));
}

Coordinator::Coordinator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Coordinator::~Coordinator() { stop(); }

FrameSource& Coordinator::frames() { return impl_->frames(); }

const api::Api& Coordinator::api() const { return impl_->api(); }
const observe::SharedTelemetry& Coordinator::telemetry() const { return impl_->telemetry(); }

const std::vector<std::string>& Coordinator::grpcAddresses() const {
    return impl_->door().addresses();
}

absl::Status Coordinator::setScene(fabric::Scene scene, std::optional<fabric::Scene> asNamed) {
    RETURN_IF_ERROR(check(scene));
    if (!asNamed)
        asNamed = scene;
    impl_->setScene(std::move(scene), *std::move(asNamed));
    return absl::OkStatus();
}

void Coordinator::drain() { impl_->drain(); }
void Coordinator::stop() { impl_->stop(); }
void Coordinator::abandonFrames() { impl_->abandonFrames(); }

}  // namespace eyrie::coordinator
