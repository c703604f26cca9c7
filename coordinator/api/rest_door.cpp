// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/rest_door.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include <absl/strings/ascii.h>
#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>
#include <xxhash.h>

#include "coordinator/api/api_page.h"
#include "coordinator/api/bench_reports.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/media_types.h"
#include "coordinator/api/openapi.h"
#include "coordinator/api/problem_json.h"
#include "coordinator/api/rest_request.h"
#include "coordinator/api/rest_routes.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/json_text.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

using google::protobuf::Message;
using google::protobuf::MessageFactory;

constexpr std::string_view kPrefix = "/api/v1";

RestAnswer problem(const absl::Status& status, int httpStatus,
                   const google::protobuf::Descriptor* request = nullptr) {
    RestAnswer answer;
    answer.status = httpStatus;
    answer.contentType = "application/problem+json";
    if (httpStatus == 429 || httpStatus == 503)
        answer.headers.emplace_back("Retry-After", "1");
    answer.body = std::make_shared<const std::string>(problemJson(status, httpStatus, request));
    return answer;
}

std::shared_ptr<Message> newMessage(const google::protobuf::Descriptor* type) {
    return std::shared_ptr<Message>(MessageFactory::generated_factory()->GetPrototype(type)->New());
}

std::string jsonOf(const Message& message, bool isSparse, bool isOneLine = false) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = !isOneLine;
    options.always_print_primitive_fields = !isSparse;
    std::string text;
    if (!google::protobuf::util::MessageToJsonString(message, &text, options).ok())
        return "{}";
    if (!isOneLine)
        fabric::joinNumbers(text);
    return text;
}

/// Without the query.
std::string pathOf(const RestRequest& request) {
    return request.target.substr(0, request.target.find('?'));
}

/// "application/json" of " Application/JSON ; charset=utf-8".
std::string plainType(std::string_view text) {
    std::string type = absl::AsciiStrToLower(std::string(text.substr(0, text.find(';'))));
    type.erase(type.find_last_not_of(" \t") + 1);
    type.erase(0, type.find_first_not_of(" \t"));
    return type;
}

/// Of a media range in Accept: `;q=0.0`.
bool isRefused(std::string_view range) {
    const std::size_t weight = range.rfind("q=");
    return weight != std::string_view::npos &&
           range.find_first_not_of("0. \t", weight + 2) == std::string_view::npos;
}

bool wantsJson(std::string_view accept) {
    while (!accept.empty()) {
        const std::string_view range = accept.substr(0, accept.find(','));
        if (plainType(range) == "application/json" && !isRefused(range))
            return true;
        accept.remove_prefix(std::min(range.size() + 1, accept.size()));
    }
    return false;
}

/// Pages of other sites can send a browser's forms here, but no JSON.
absl::Status checkContentType(const RestRequest& request) {
    if (request.body.empty() || plainType(request.contentType) == "application/json")
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("the body's Content-Type is '{}'; it must be application/json",
                    std::string_view(request.contentType).substr(0, 64)));
}

/// Calls that something comes of more than once have such a field.
absl::Status setRequestId(const std::string& key, Message& message) {
    constexpr const char* kField = "request_id";
    const bool isMeant = message.GetDescriptor()->FindFieldByName(kField) != nullptr;
    return key.empty() || !isMeant ? absl::OkStatus() : setField(kField, key, message);
}

absl::Status read(const RestRequest& request, const FoundRoute& found, Message& message) {
    const v1::Rest& rest = found.route->rest;
    const std::size_t question = request.target.find('?');
    const std::string_view query =
        question == std::string::npos ? "" : std::string_view(request.target).substr(question + 1);
    const bool hasBody = rest.method() != "GET" && rest.method() != "DELETE";
    if (!hasBody && !request.body.empty())
        return absl::InvalidArgumentError(
            fmt::format("{} has no body; what is asked for goes into the query", rest.method()));
    RETURN_IF_ERROR(checkContentType(request));
    RETURN_IF_ERROR(setFromBody(request.body, rest.body(), message));
    RETURN_IF_ERROR(setFromQuery(query, message));
    for (const auto& [field, text] : found.fields) RETURN_IF_ERROR(setField(field, text, message));
    return setRequestId(request.idempotencyKey, message);
}

/// What of a picture's facts fits into a line; pages of others are saved, not shown as this
/// server's own.
void describe(const Message& message, RestAnswer& answer) {
    if (const auto* report = dynamic_cast<const v1::GetReportResponse*>(&message))
        answer.headers.emplace_back(
            "Content-Disposition",
            fmt::format("attachment; filename=\"{}\"", fileNameOf(report->file())));
    if (const auto* image = dynamic_cast<const v1::RenderImageResponse*>(&message)) {
        const double tau = image->statistics().tau_achieved();
        answer.headers.emplace_back("Eyrie-Tau-Achieved",
                                    std::isinf(tau) ? "Infinity" : fmt::format("{}", tau));
        answer.headers.emplace_back("Eyrie-Complete",
                                    image->statistics().complete() ? "true" : "false");
        answer.headers.emplace_back("Eyrie-Revision", fmt::format("{}", image->revision()));
    }
}

/// `bytes`, which lie in `owner`, as a body: with it go both, and the room that the answer takes
/// up.
std::shared_ptr<const std::string> bodyIn(std::shared_ptr<const void> owner,
                                          const std::string& bytes, std::shared_ptr<void> room) {
    using Held = std::pair<std::shared_ptr<const void>, std::shared_ptr<void>>;
    return {std::make_shared<const Held>(std::move(owner), std::move(room)), &bytes};
}

RestAnswer bytesOf(const std::shared_ptr<const Message>& message, const std::string& field,
                   std::shared_ptr<void> room) {
    const auto* descriptor = message->GetDescriptor()->FindFieldByName(field);
    RestAnswer answer;
    answer.contentType = mediaTypeOf(*message);
    describe(*message, answer);
    std::string unused;  // generated messages have their strings
    const std::string& bytes =
        message->GetReflection()->GetStringReference(*message, descriptor, &unused);
    answer.body = bodyIn(message, bytes, std::move(room));
    return answer;
}

RestAnswer jsonAnswer(const Message& message, const v1::Rest& rest, std::shared_ptr<void> room) {
    const Message* part = &message;
    if (!rest.answer().empty())
        part = &message.GetReflection()->GetMessage(
            message, message.GetDescriptor()->FindFieldByName(rest.answer()));
    RestAnswer answer;
    const auto text = std::make_shared<const std::string>(jsonOf(*part, rest.sparse()));
    answer.body = bodyIn(text, *text, std::move(room));
    return answer;
}

/// Empty: it has none, as where there is nothing.
std::string tagOf(const RestAnswer& answer) {
    const auto isTag = [](const auto& header) { return header.first == "ETag"; };
    const auto tag = std::ranges::find_if(answer.headers, isTag);
    return tag == answer.headers.end() ? "" : tag->second;
}

/// How tags are compared: RFC 9110, 8.8.3.2.
enum class Comparison {
    Strong,  ///< W/"…" does not count
    Weak,    ///< it does
};

/// Whether `tags` of a header are "*" or have `etag` among them.
bool isListed(std::string_view etag, std::string_view tags, Comparison comparison) {
    if (tags == "*")
        return true;
    for (std::size_t at = tags.find(etag); at != std::string_view::npos;
         at = tags.find(etag, at + etag.size()))
        if (comparison == Comparison::Weak || !tags.substr(0, at).ends_with("W/"))
            return true;
    return false;
}

/// Whether there is something with a tag that If-None-Match has: RFC 9110, 13.1.2.
bool isKnown(const RestRequest& request, const std::string& etag) {
    return isListed(etag, request.ifNoneMatch, Comparison::Weak);
}

/// Whether what a change was meant for is what there is: RFC 9110, 13.2.2. `etag` is empty where
/// there is nothing.
bool isMet(const RestRequest& request, const std::string& etag) {
    const bool isThere = !etag.empty();
    return (request.ifMatch.empty() ||
            (isThere && isListed(etag, request.ifMatch, Comparison::Strong))) &&
           !(isThere && isKnown(request, etag));
}

void tag(const RestRequest& request, RestAnswer& answer) {
    const std::string etag =
        fmt::format("\"{:016x}\"", XXH64(answer.body->data(), answer.body->size(), 0));
    answer.headers.emplace_back("ETag", etag);
    if (!isKnown(request, etag))
        return;
    answer.status = 304;
    answer.body = std::make_shared<const std::string>();
}

/// What there is, for programs.
RestAnswer document(const RestRequest& request) {
    RestAnswer answer;
    static const auto text = std::make_shared<const std::string>(openApiJson());
    answer.body = text;
    tag(request, answer);
    return answer;
}

bool reads(const RestRequest& request) {
    return request.method == "GET" || request.method == "HEAD";
}

RestAnswer notDone(const RestRequest& request, const std::string& allowed) {
    RestAnswer answer =
        problem(absl::UnimplementedError(fmt::format("{} is not done here; this path has {}",
                                                     request.method.substr(0, 16), allowed)),
                405);
    answer.headers.emplace_back("Allow", allowed);
    return answer;
}

/// What there is, for people.
RestAnswer page(const RestRequest& request, std::string_view path) {
    const bool isStyle = path == kApiStylePath;
    if (!isStyle && path != "/api" && path != "/api/")
        return problem(absl::NotFoundError("there is nothing at this path; see /api"), 404);
    if (!reads(request))
        return notDone(request, "GET");
    RestAnswer answer;
    answer.contentType = isStyle ? "text/css; charset=utf-8" : "text/html; charset=utf-8";
    answer.body = std::make_shared<const std::string>(
        isStyle ? apiStyle() : apiPage(path == "/api/" ? "" : "api/"));
    return answer;
}

RestAnswer notThere(const RestRequest& request, const FoundRoute& found) {
    if (found.allowed.empty())
        return problem(
            absl::NotFoundError("there is nothing at this path; see /api for what there is"), 404);
    return notDone(request, found.allowed);
}

}  // namespace

RestAnswer RestDoor::answer(const RestRequest& request) const {
    const std::string_view target(request.target);
    const std::string_view path = target.substr(0, target.find('?'));
    if (!path.starts_with(kPrefix))
        return page(request, path);
    if (path == "/api/v1/openapi.json")
        return reads(request) ? document(request) : notDone(request, "GET");
    const FoundRoute found = findRoute(request.method, path.substr(kPrefix.size()));
    if (found.route == nullptr)
        return notThere(request, found);
    if (found.route->call->server_streaming())
        return stream(request, found, *newMessage(found.route->call->input_type()));
    return changes(found.route->rest) ? change(request, found) : call(request, found);
}

RestDoor::Made RestDoor::make(const RestRequest& request, const FoundRoute& found) const {
    const auto asked = newMessage(found.route->call->input_type());
    const auto made = newMessage(found.route->call->output_type());
    const v1::Rest& rest = found.route->rest;
    const bool asText = rest.bytes().empty() || wantsJson(request.accept);
    std::shared_ptr<void> room;
    absl::Status status = read(request, found, *asked);
    if (status.ok())
        status = handlers_.handle(found.route->call->name(), *asked, *made,
                                  {request.stop, request.role, asText, &room});
    if (!status.ok())
        return {status, problem(status, httpStatusOf(status.code()), asked->GetDescriptor())};
    RestAnswer answer = asText ? jsonAnswer(*made, rest, room) : bytesOf(made, rest.bytes(), room);
    if (rest.method() == "GET")
        tag(request, answer);
    return {status, std::move(answer)};
}

RestAnswer RestDoor::call(const RestRequest& request, const FoundRoute& found) const {
    Made made = make(request, found);
    handlers_.note(found.route->call->name(), made.status);
    return std::move(made.answer);
}

RestAnswer RestDoor::change(const RestRequest& request, const FoundRoute& found) const {
    const std::size_t place = std::hash<std::string>()(pathOf(request)) % changing_.size();
    const std::lock_guard lock(changing_[place]);
    if (!request.ifMatch.empty() || !request.ifNoneMatch.empty()) {
        Made before = there(request);
        if (!before.status.ok() && !absl::IsNotFound(before.status)) {
            handlers_.note(found.route->call->name(), before.status);
            return std::move(before.answer);
        }
        if (!isMet(request, tagOf(before.answer)))
            return problem(
                absl::FailedPreconditionError(
                    "what is there is not what If-Match or If-None-Match says; ask for it again, "
                    "and see whether the change is still wanted"),
                412);
    }
    RestAnswer answer = call(request, found);
    if (answer.status != 200 || found.route->rest.method() == "DELETE")
        return answer;
    if (std::string now = tagOf(there(request).answer); !now.empty())
        answer.headers.emplace_back("ETag", std::move(now));
    return answer;
}

/// What GET has at the path of `change`, of which nobody is told.
RestDoor::Made RestDoor::there(const RestRequest& change) const {
    RestRequest request;
    request.method = "GET";
    request.target = pathOf(change);
    request.stop = change.stop;
    request.role = change.role;
    const FoundRoute found =
        findRoute(request.method, std::string_view(request.target).substr(kPrefix.size()));
    return found.route == nullptr ? Made{absl::NotFoundError(""), {}} : make(request, found);
}

RestAnswer RestDoor::stream(const RestRequest& request, const FoundRoute& found,
                            Message& asked) const {
    absl::Status status = read(request, found, asked);
    RestAnswer answer;
    answer.contentType = "text/event-stream";
    if (status.ok() && request.method != "HEAD") {
        absl::StatusOr<std::unique_ptr<MessageStream>> messages =
            handlers_.open(found.route->call->name(), asked);
        status = messages.status();
        if (status.ok())
            answer.events = *std::move(messages);
    }
    handlers_.note(found.route->call->name(), status);
    return status.ok() ? answer
                       : problem(status, httpStatusOf(status.code()), asked.GetDescriptor());
}

std::optional<RestAnswer> RestDoor::refusal(std::string_view address) const {
    const absl::Status status = handlers_.admit(address);
    return status.ok() ? std::nullopt : std::optional(problem(status, httpStatusOf(status.code())));
}

std::string eventOf(const Message& message) {
    return fmt::format("data: {}\n\n", jsonOf(message, false, true));
}

RestAnswer busyAnswer() {
    return problem(absl::ResourceExhaustedError("too many calls wait; try again in a bit"), 503);
}

}  // namespace eyrie::api
