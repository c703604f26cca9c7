// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/api_page.h"

#include <set>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "coordinator/api/call_roles.h"
#include "coordinator/api/problem_json.h"
#include "coordinator/api/rest_routes.h"
#include "coordinator/api/schema.h"

namespace eyrie::api {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text) switch (c) {
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '&':
                html += "&amp;";
                break;
            case '"':
                html += "&quot;";
                break;
            default:
                html += c;
        }
    return html;
}

/// Types in the order in which they are met.
class Types {
public:
    std::string linkTo(const std::string& name, const Descriptor* message,
                       const EnumDescriptor* values) {
        if (seen_.insert(name).second) {
            if (message != nullptr)
                messages.push_back(message);
            else
                enumerations.push_back(values);
        }
        return fmt::format("<a href=\"#{0}\">{0}</a>", name);
    }

    std::vector<const Descriptor*> messages;
    std::vector<const EnumDescriptor*> enumerations;

private:
    std::set<std::string> seen_;
};

std::string typeOf(const FieldDescriptor& field, Types& types) {
    std::string name = field.type_name();
    if (field.type() == FieldDescriptor::TYPE_MESSAGE)
        name = types.linkTo(field.message_type()->name(), field.message_type(), nullptr);
    if (field.type() == FieldDescriptor::TYPE_ENUM)
        name = types.linkTo(field.enum_type()->name(), nullptr, field.enum_type());
    return field.is_repeated() ? name + " list" : name;
}

std::string fieldTable(const Descriptor& message, Types& types) {
    std::string rows;
    for (int i = 0; i < message.field_count(); ++i) {
        const FieldDescriptor& field = *message.field(i);
        rows += fmt::format("<tr><td><code>{}</code><td>{}<td>{}\n", field.json_name(),
                            typeOf(field, types), escaped(commentOf(field)));
    }
    return rows.empty() ? "<p>No fields.\n"
                        : "<table><tr><th>Field<th>Type<th>Meaning\n" + rows + "</table>\n";
}

std::string commandOf(const v1::Rest& rest) {
    std::string path = rest.path();
    if (const std::size_t field = path.find('{'); field != std::string::npos)
        path.replace(field, path.find('}') - field + 1, rest.example_name());
    const std::string url = "http://127.0.0.1:8080/api/v1" + path;
    const std::string output = rest.bytes() == "image" ? " -o picture.png"
                               : rest.bytes().empty()  ? ""
                                                       : " -o file";
    if (rest.method() == "GET")
        return fmt::format("curl{} '{}{}{}'", output, url, rest.example().empty() ? "" : "?",
                           rest.example());
    const std::string body = rest.example().empty() && rest.method() != "DELETE"
                                 ? " --json @body.json"
                             : rest.method() == "DELETE" ? ""
                                                         : " --json '" + rest.example() + "'";
    // --json alone asks for the answer as JSON, too.
    const char* const accept = rest.bytes().empty() ? "" : " --header 'Accept: image/png'";
    return fmt::format("curl{} -X {}{}{} '{}'", output, rest.method(), body, accept, url);
}

/// By HTTP a call may have one field alone as its body, or as its answer.
std::string alone(const Descriptor& message, const std::string& field, const char* what,
                  Types& types) {
    if (field.empty())
        return "";
    return fmt::format("<p>By HTTP {} is <code>{}</code> alone: {}.\n", what, field,
                       typeOf(*message.FindFieldByName(field), types));
}

std::string callSection(const Route& route, bool isFirst, Types& types) {
    const auto& call = *documentedService().FindMethodByName(route.call->name());
    std::string html;
    if (isFirst)
        html +=
            fmt::format("<h2 id=\"{0}\">{0}</h2>\n<p>{1}\n", call.name(), escaped(commentOf(call)));
    html += fmt::format("<h3><code>{} /api/v1{}</code></h3>\n<pre>{}</pre>\n", route.rest.method(),
                        route.rest.path(), escaped(commandOf(route.rest)));
    if (!isFirst)
        return html;
    html += fmt::format("<p>For tokens of role <code>{}</code>.\n",
                        access::nameOf(roleFor(call.name())));
    if (call.server_streaming())
        html +=
            "<p>The answer is <code>text/event-stream</code>: one event for each message below.\n";
    html += "<h4>Asked</h4>\n" + fieldTable(*call.input_type(), types) +
            alone(*call.input_type(), route.rest.body(), "the body", types);
    return html + "<h4>Answered</h4>\n" + fieldTable(*call.output_type(), types) +
           alone(*call.output_type(), route.rest.answer(), "the answer", types);
}

std::string typeSections(Types& types) {
    std::string html = "<h2>Types</h2>\n";
    for (std::size_t i = 0; i < types.messages.size(); ++i) {
        const Descriptor& message = *types.messages[i];  // tables may add to the list
        html += fmt::format("<h3 id=\"{0}\">{0}</h3>\n<p>{1}\n", message.name(),
                            escaped(commentOf(message)));
        html += fieldTable(message, types);
    }
    for (const EnumDescriptor* values : types.enumerations) {
        html += fmt::format("<h3 id=\"{0}\">{0}</h3>\n<p>{1}\n<table>", values->name(),
                            escaped(commentOf(*values)));
        for (int i = 0; i < values->value_count(); ++i)
            html += fmt::format("<tr><td><code>{}</code><td>{}\n", values->value(i)->name(),
                                escaped(commentOf(*values->value(i))));
        html += "</table>\n";
    }
    return html;
}

/// More of its HTTP statuses.
std::string_view othersOf(absl::StatusCode code) {
    switch (code) {
        case absl::StatusCode::kResourceExhausted:
            return "; 413 of a body that is too long, 431 of headers, 503 while too many calls "
                   "wait";
        case absl::StatusCode::kFailedPrecondition:
            return "; 412 where If-Match or If-None-Match is not met";
        case absl::StatusCode::kUnimplemented:
            return "; 405 of a method that the path does not have";
        default:
            return "";
    }
}

std::string errorSection() {
    std::string rows;
    for (int number = 1; number <= static_cast<int>(absl::StatusCode::kUnauthenticated); ++number) {
        const auto code = static_cast<absl::StatusCode>(number);
        rows += fmt::format("<tr id=\"{0}\"><td><code>{0}</code><td>{1}{2}\n",
                            std::string(absl::StatusCodeToString(code)), httpStatusOf(code),
                            othersOf(code));
    }
    return "<h2>Errors</h2>\n<p>Errors are <code>application/problem+json</code> (RFC 9457): "
           "<code>detail</code> says what is wrong, <code>field</code> where in the request, and "
           "<code>remedy</code> what to do. Their <code>code</code> is gRPC's:\n"
           "<table><tr><th>Code<th>HTTP\n" +
           rows + "</table>\n";
}

}  // namespace

std::string apiPage(std::string_view folder) {
    Types types;
    std::string calls;
    const google::protobuf::MethodDescriptor* last = nullptr;
    for (const Route& route : restRoutes()) {
        calls += callSection(route, route.call != last, types);
        last = route.call;
    }
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width\">"
        "<title>Eyrie: what programs can ask</title><link rel=\"stylesheet\" "
        "href=\"{0}style.css\">\n"
        "<main>\n<h1>What programs can ask</h1>\n<p>{1} Bodies are JSON, sent as "
        "<code>application/json</code>. For programs this page is <a "
        "href=\"{0}v1/openapi.json\">/api/v1/openapi.json</a> (OpenAPI 3.1).\n"
        "<p>A server with tokens (<code>--token-file</code>) wants one with each call: "
        "<code>Authorization: Bearer TOKEN</code>, of curl <code>--oauth2-bearer TOKEN</code>. "
        "What GET answers has an <code>ETag</code>; with it as <code>If-Match</code> a change is "
        "made only where nobody else has made one by HTTP since, and is 412 otherwise.\n"
        "{2}{3}{4}</main>\n",
        folder, escaped(commentOf(documentedService())), calls, errorSection(),
        typeSections(types));
}

std::string apiStyle() {
    return ":root{color-scheme:light dark;font:16px/1.5 system-ui,sans-serif}"
           "main{max-width:60rem;margin:auto;padding:1rem}"
           "pre{overflow-x:auto;padding:.5rem;border:1px solid GrayText;border-radius:4px}"
           "table{border-collapse:collapse;width:100%}"
           "td,th{text-align:left;vertical-align:top;padding:.2rem .5rem;"
           "border-bottom:1px solid GrayText}"
           "h2{margin-top:2.5rem;border-bottom:2px solid}\n";
}

}  // namespace eyrie::api
