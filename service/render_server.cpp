// SPDX-License-Identifier: Apache-2.0
#include "service/render_server.h"

#include <utility>

#include <grpcpp/ext/health_check_service_server_builder_option.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server.h>

#include "fabric/status.h"
#include "service/render_service.h"
#include "wire/deadline.h"
#include "wire/listen.h"

namespace eyrie::service {

class RenderServer::Impl {
public:
    Impl(GlThread& thread, const wire::Security& security)
        : service_(thread, security), security_(security) {}

    absl::Status listen(const std::string& address) {
        grpc::EnableDefaultHealthCheckService(true);
        ASSIGN_OR_RETURN(wire::Listening listening, wire::listen({address}, service_, security_));
        server_ = std::move(listening.server);
        address_ = listening.addresses.front();
        return absl::OkStatus();
    }

    void announceLeaving() {
        if (server_->GetHealthCheckService() != nullptr)
            server_->GetHealthCheckService()->SetServingStatus(false);
    }

    void stop(std::chrono::milliseconds grace) {
        if (server_->GetHealthCheckService() != nullptr)
            server_->GetHealthCheckService()->Shutdown();
        server_->Shutdown(wire::deadlineIn(grace));
    }

    const std::string& address() const { return address_; }

private:
    RenderService service_;
    const wire::Security security_;
    std::unique_ptr<grpc::Server> server_;
    std::string address_;
};

absl::StatusOr<std::unique_ptr<RenderServer>> RenderServer::start(const std::string& address,
                                                                  GlThread& thread,
                                                                  const wire::Security& security) {
    auto impl = std::make_unique<Impl>(thread, security);
    RETURN_IF_ERROR(impl->listen(address));
    return std::unique_ptr<RenderServer>(new RenderServer(std::move(impl)));
}

RenderServer::RenderServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RenderServer::~RenderServer() { stop(std::chrono::milliseconds(0)); }

const std::string& RenderServer::address() const { return impl_->address(); }
void RenderServer::announceLeaving() { impl_->announceLeaving(); }
void RenderServer::stop(std::chrono::milliseconds grace) { impl_->stop(grace); }

}  // namespace eyrie::service
