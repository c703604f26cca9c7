// SPDX-License-Identifier: Apache-2.0
#include "service/renderer_node.h"

#include <utility>

#include "fabric/status.h"
#include "service/gl_thread.h"
#include "service/registration.h"
#include "service/render_server.h"
#include "wire/listen.h"
#include "wire/picture_heap.h"

namespace eyrie::service {
namespace {

/// For what is still under way when the coordinator has nothing more to do.
constexpr std::chrono::seconds kGrace{1};

}  // namespace

absl::StatusOr<std::unique_ptr<RendererNode>> RendererNode::start(
    const RendererNodeOptions& options, const DrawerFactory& create) {
    RETURN_IF_ERROR(wire::checkAddress(options.coordinator));
    RETURN_IF_ERROR(wire::checkAddress(options.listen));
    wire::keepPictureHeap();
    ASSIGN_OR_RETURN(std::unique_ptr<GlThread> thread, GlThread::start(create));
    ASSIGN_OR_RETURN(std::unique_ptr<RenderServer> server,
                     RenderServer::start(options.listen, *thread, options.security));
    return std::unique_ptr<RendererNode>(
        new RendererNode(options, std::move(thread), std::move(server)));
}

RendererNode::RendererNode(RendererNodeOptions options, std::unique_ptr<GlThread> thread,
                           std::unique_ptr<RenderServer> server)
    : options_(std::move(options)), thread_(std::move(thread)), server_(std::move(server)) {}

RendererNode::~RendererNode() = default;

const fabric::DeviceInfo& RendererNode::device() const { return thread_->device(); }
const std::string& RendererNode::address() const { return server_->address(); }

absl::Status RendererNode::run(const std::stop_token& stop) {
    RegistrationOptions registration{
        options_.coordinator,   address(),   device(), options_.node, options_.security,
        options_.retryInterval, std::nullopt};
    if (options_.exitWithCoordinator)
        registration.giveUpAfter = options_.giveUpAfter;
    const std::stop_callback leaving(stop, [this] { server_->announceLeaving(); });
    const absl::Status status = keepRegistered(registration, stop);
    server_->stop(kGrace);
    return status;
}

}  // namespace eyrie::service
