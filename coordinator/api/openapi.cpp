// SPDX-License-Identifier: Apache-2.0
// OpenAPI Specification 3.1.0, 2021; protobuf's JSON mapping
// (protobuf.dev/programming-guides/json).
#include "coordinator/api/openapi.h"

#include <map>
#include <optional>

#include <fmt/format.h>

#include "coordinator/api/call_roles.h"
#include "coordinator/api/json_text.h"
#include "coordinator/api/media_types.h"
#include "coordinator/api/rest_routes.h"
#include "coordinator/api/schema.h"
#include "fabric/json_text.h"
#include "fabric/version.h"

namespace eyrie::api {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::MethodDescriptor;

std::string firstSentence(const std::string& text) {
    const std::size_t end = text.find_first_of(".:");
    return text.substr(0, end);
}

std::string refTo(std::string_view name) {
    return JsonMembers().text("$ref", fmt::format("#/components/schemas/{}", name)).str();
}

std::string nameOf(const Descriptor& type) {
    return type.containing_type() == nullptr ? type.name()
                                             : type.containing_type()->name() + type.name();
}

/// The document in the making: schemas are those that were referred to.
class Document {
public:
    explicit Document(const google::protobuf::ServiceDescriptor& service) : service_(service) {}

    std::string str() {
        const std::string paths = pathsJson();
        JsonMembers schemas;
        schemas.raw("Problem", kProblem);
        for (const auto& [name, schema] : schemas_) schemas.raw(name, schema);
        return JsonMembers()
            .text("openapi", "3.1.0")
            .raw("info", JsonMembers()
                             .text("title", "Eyrie")
                             .text("version", fabric::kVersion)
                             .text("summary", "Terrain and massive models, rendered")
                             .text("description", commentOf(service_))
                             .raw("license", R"({"name":"Apache-2.0","identifier":"Apache-2.0"})")
                             .str())
            .raw("servers", R"([{"url":"/api/v1"}])")
            .raw("security", R"([{"token":[]},{}])")
            .raw("paths", paths)
            .raw("components", JsonMembers()
                                   .raw("schemas", schemas.str())
                                   .raw("securitySchemes", kSecuritySchemes)
                                   .str())
            .str();
    }

    std::vector<std::string> undocumented;

private:
    static constexpr std::string_view kProblem =
        R"({"type":"object","description":"What is wrong (RFC 9457).","required":["type","title",)"
        R"("status","detail","code"],"properties":{)"
        R"("type":{"type":"string","description":"What kind of error, a place of /api."},)"
        R"("title":{"type":"string","description":"The kind, for people."},)"
        R"("status":{"type":"integer","description":"The HTTP status."},)"
        R"("detail":{"type":"string","description":"What is wrong here, for people."},)"
        R"("code":{"type":"string","description":"The kind, as gRPC calls it."},)"
        R"("field":{"type":"string","description":"Of the request, where it is one."},)"
        R"("remedy":{"type":"string","description":"What to do about it."}},)"
        R"("additionalProperties":false})";

    static constexpr std::string_view kSecuritySchemes =
        R"({"token":{"type":"http","scheme":"bearer","description":"One of the file that the )"
        R"(server was started with (--token-file); without a file it asks nobody for any."}})";

    template <typename Described>
    std::string documented(const Described& described) {
        std::string comment = commentOf(described);
        if (comment.empty())
            undocumented.push_back(described.full_name());
        return comment;
    }

    std::string refTo(const Descriptor& type) {
        const std::string name = nameOf(type);
        if (schemas_.emplace(name, "").second)
            schemas_[name] = schemaOf(type);
        return api::refTo(name);
    }

    std::string refTo(const EnumDescriptor& type) {
        if (schemas_.emplace(type.name(), "").second)
            schemas_[type.name()] = schemaOf(type);
        return api::refTo(type.name());
    }

    std::string schemaOf(const Descriptor& type) {
        JsonMembers properties;
        for (int i = 0; i < type.field_count(); ++i)
            properties.raw(type.field(i)->json_name(), schemaOf(*type.field(i), true));
        JsonMembers schema;
        schema.text("type", "object");
        if (const std::string comment = commentOf(type); !comment.empty())
            schema.text("description", comment);
        return schema.raw("properties", properties.str())
            .raw("additionalProperties", "false")
            .str();
    }

    std::string schemaOf(const EnumDescriptor& type) {
        std::vector<std::string> values;
        std::string text = commentOf(type);
        for (int i = 0; i < type.value_count(); ++i) {
            values.push_back(fabric::quotedJson(type.value(i)->name()));
            text += fmt::format("{}{}: {}", text.empty() ? "" : " ", type.value(i)->name(),
                                documented(*type.value(i)));
        }
        return JsonMembers()
            .text("type", "string")
            .text("description", text)
            .raw("enum", jsonList(values))
            .str();
    }

    std::string schemaOf(const FieldDescriptor& field, bool withComment) {
        const std::string description =
            withComment ? ",\"description\":" + fabric::quotedJson(documented(field)) : "";
        std::string one = elementOf(field);
        if (field.is_repeated())
            one = JsonMembers().text("type", "array").raw("items", one).str();
        return one.substr(0, one.size() - 1) + description + "}";
    }

    std::string elementOf(const FieldDescriptor& field) {
        switch (field.type()) {
            case FieldDescriptor::TYPE_MESSAGE:
                return refTo(*field.message_type());
            case FieldDescriptor::TYPE_ENUM:
                return refTo(*field.enum_type());
            case FieldDescriptor::TYPE_DOUBLE:
            case FieldDescriptor::TYPE_FLOAT:
                return R"({"anyOf":[{"type":"number"},{"enum":["Infinity","-Infinity","NaN"]}]})";
            case FieldDescriptor::TYPE_BOOL:
                return R"({"type":"boolean"})";
            case FieldDescriptor::TYPE_STRING:
                return R"({"type":"string"})";
            case FieldDescriptor::TYPE_BYTES:
                return R"({"type":"string","contentEncoding":"base64"})";
            case FieldDescriptor::TYPE_INT64:
            case FieldDescriptor::TYPE_UINT64:
            case FieldDescriptor::TYPE_FIXED64:
                return R"({"type":"string","pattern":"^-?[0-9]+$"})";
            default:
                return R"({"type":"integer"})";
        }
    }

    /// The parameter that `field` is in a query or path.
    std::string parameter(const FieldDescriptor& field, std::string_view place,
                          const std::string& example) {
        JsonMembers parameter;
        // A field in a path keeps the name that the path has for it.
        parameter.text("name", place == "path" ? field.name() : field.json_name())
            .text("in", place)
            .text("description", documented(field))
            .raw("schema", schemaOf(field, false));
        if (place == "path")
            parameter.raw("required", "true");
        if (!example.empty())
            parameter.raw("example", field.cpp_type() == FieldDescriptor::CPPTYPE_STRING
                                         ? fabric::quotedJson(example)
                                         : example);
        return parameter.str();
    }

    static std::string exampleOf(const v1::Rest& rest, const std::string& name) {
        const std::string query = "&" + rest.example() + "&";
        const std::size_t at = query.find("&" + name + "=");
        if (at == std::string::npos)
            return "";
        const std::size_t from = at + name.size() + 2;
        return query.substr(from, query.find('&', from) - from);
    }

    std::string parametersOf(const MethodDescriptor& call, const v1::Rest& rest) {
        const Descriptor& request = *call.input_type();
        const bool hasQuery = rest.method() == "GET" || rest.method() == "DELETE";
        std::vector<std::string> parameters;
        for (int i = 0; i < request.field_count(); ++i) {
            const FieldDescriptor& field = *request.field(i);
            const bool isPlain =
                !field.is_repeated() && field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE;
            if (rest.path().find("{" + field.name() + "}") != std::string::npos)
                parameters.push_back(parameter(field, "path", rest.example_name()));
            else if (hasQuery && isPlain)
                parameters.push_back(parameter(field, "query", exampleOf(rest, field.json_name())));
        }
        addHeaderParameters(call, rest, parameters);
        return jsonList(parameters);
    }

    static void addHeaderParameters(const MethodDescriptor& call, const v1::Rest& rest,
                                    std::vector<std::string>& parameters) {
        const auto add = [&](std::string_view name, std::string_view description) {
            parameters.push_back(JsonMembers()
                                     .text("name", name)
                                     .text("in", "header")
                                     .text("description", description)
                                     .raw("schema", R"({"type":"string"})")
                                     .str());
        };
        if (changes(rest))
            add("If-Match",
                "The ETag that GET had at this path: where it has another by now, nothing is done, "
                "and the answer is 412.");
        if (rest.method() == "PUT")
            add("If-None-Match", "*: where there is something already, the answer is 412.");
        if (rest.method() == "GET" && !call.server_streaming())
            add("If-None-Match", "An ETag: where it is still right, the answer is 304.");
        if (call.input_type()->FindFieldByName("request_id") != nullptr)
            add("Idempotency-Key", "The same as requestId.");
    }

    static std::string header(std::string_view description) {
        return JsonMembers()
            .text("description", description)
            .raw("schema", R"({"type":"string"})")
            .str();
    }

    static std::string headersOf(const Descriptor& response, const v1::Rest& rest) {
        JsonMembers headers;
        if (rest.method() == "GET")
            headers.raw("ETag", header("Another one where the answer is another."));
        if (rest.method() == "PUT" || rest.method() == "PATCH")
            headers.raw("ETag", header("The one that GET has now at this path."));
        for (const auto& [name, description] : headersOfBytes(response))
            headers.raw(name, header(description));
        return headers.str();
    }

    std::string bodyOf(const MethodDescriptor& call, const v1::Rest& rest) {
        const Descriptor& request = *call.input_type();
        JsonMembers content;
        content.raw("schema", rest.body().empty()
                                  ? refTo(request)
                                  : refTo(*request.FindFieldByName(rest.body())->message_type()));
        if (!rest.example().empty())
            content.raw("example", rest.example());
        return JsonMembers()
            .raw("required", "true")
            .raw("content", JsonMembers().raw("application/json", content.str()).str())
            .str();
    }

    std::string responsesOf(const MethodDescriptor& call, const v1::Rest& rest) {
        const Descriptor& response = *call.output_type();
        const auto* part =
            rest.answer().empty() ? nullptr : response.FindFieldByName(rest.answer());
        JsonMembers content;
        if (!rest.bytes().empty())
            for (const std::string_view type : mediaTypesOf(response)) content.raw(type, "{}");
        // Of a server-sent event the schema is that of its data.
        content.raw(call.server_streaming() ? "text/event-stream" : "application/json",
                    JsonMembers()
                        .raw("schema", refTo(part == nullptr ? response : *part->message_type()))
                        .str());
        JsonMembers responses;
        JsonMembers good;
        good.text("description", "The answer");
        if (!call.server_streaming())
            good.raw("headers", headersOf(response, rest));
        responses.raw("200", good.raw("content", content.str()).str());
        if (rest.method() == "GET" && !call.server_streaming())
            responses.raw(
                "304",
                JsonMembers()
                    .text("description", "It is as If-None-Match has it")
                    .raw("headers",
                         JsonMembers().raw("ETag", header("Of the answer that is not sent.")).str())
                    .str());
        if (changes(rest))
            responses.raw("412", problem("It is not as If-Match or If-None-Match has it"));
        const std::string later =
            JsonMembers()
                .raw("Retry-After", header("Of 429 and 503: seconds after which to try again."))
                .str();
        return responses.raw("default", problem("An error", later)).str();
    }

    static std::string problem(std::string_view description, const std::string& headers = "{}") {
        const std::string schema = JsonMembers().raw("schema", api::refTo("Problem")).str();
        return JsonMembers()
            .text("description", description)
            .raw("headers", headers)
            .raw("content", JsonMembers().raw("application/problem+json", schema).str())
            .str();
    }

    std::string operationOf(const MethodDescriptor& call, const v1::Rest& rest, bool isFirst) {
        const std::string comment = documented(call);
        JsonMembers operation;
        operation.text("operationId", isFirst ? call.name() : call.name() + "By" + rest.method())
            .text("summary", firstSentence(comment))
            .text("description", fmt::format("{} For tokens of role {}.", comment,
                                             access::nameOf(roleFor(call.name()))))
            .raw("parameters", parametersOf(call, rest));
        if (rest.method() != "GET" && rest.method() != "DELETE")
            operation.raw("requestBody", bodyOf(call, rest));
        return operation.raw("responses", responsesOf(call, rest)).str();
    }

    std::string pathsJson() {
        std::vector<std::string> order;
        std::map<std::string, JsonMembers> paths;
        const MethodDescriptor* last = nullptr;
        for (const Route& route : restRoutes()) {
            const MethodDescriptor& call = *service_.FindMethodByName(route.call->name());
            if (!paths.contains(route.rest.path()))
                order.push_back(route.rest.path());
            std::string method = route.rest.method();
            for (char& c : method) c = static_cast<char>(c - 'A' + 'a');
            paths[route.rest.path()].raw(method, operationOf(call, route.rest, last != &call));
            last = &call;
        }
        JsonMembers json;
        for (const std::string& path : order) json.raw(path, paths[path].str());
        return json.str();
    }

    const google::protobuf::ServiceDescriptor& service_;
    std::map<std::string, std::string> schemas_;
};

struct Made {
    std::string json;
    std::vector<std::string> undocumented;
};

const Made& made() {
    static const Made result = [] {
        Document document(documentedService());
        std::string json = document.str();
        return Made{std::move(json), std::move(document.undocumented)};
    }();
    return result;
}

}  // namespace

const std::string& openApiJson() { return made().json; }
const std::vector<std::string>& undocumented() { return made().undocumented; }

}  // namespace eyrie::api
