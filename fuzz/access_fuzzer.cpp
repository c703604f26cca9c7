// SPDX-License-Identifier: Apache-2.0
// What strangers send to get in, and names of data, of any bytes. The first line is an
// Authorization, the second a cookie, the third an origin, the fourth a host and a request's
// target, and all of it a token file and a name.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "access/data_folder.h"
#include "access/gate.h"
#include "coordinator/http/access.h"
#include "coordinator/http/origin.h"
#include "coordinator/http/request_target.h"

namespace {

/// What comes of a target is a host and a path below it, and together what was sent.
void checkTarget(std::string_view text) {
    const auto found = eyrie::http::absoluteTarget(text, false);
    if (!found.ok() || !*found)
        return;
    const auto& [host, target] = **found;
    if (host.empty() || host.find_first_of("/?#@\\%") != std::string::npos ||
        !target.starts_with('/') ||
        !(text.ends_with(target) || text.ends_with(host + target.substr(1))))
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    static access::Gate gate(*access::Tokens::parse("admin a-secret-that-no-input-has-in-it", "t"));
    std::array<std::string_view, 4> lines;
    std::string_view rest = text;
    for (std::string_view& line : lines) {
        line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    }
    for (const http::TicketCookie& cookie : http::ticketCookies(lines[1]))
        if (cookie.ticket.empty() ||
            gate.admit({lines[0], cookie.ticket}, "fuzz", access::Role::View).ok() ||
            gate.admit({"", cookie.ticket}, "fuzz", access::Role::View).ok())
            std::abort();
    if (gate.admit({lines[0], {}}, "fuzz", access::Role::View).ok())
        std::abort();
    if (http::isAllowedOrigin(lines[2], lines[3], true) && lines[2].find("evil") != lines[2].npos)
        std::abort();  // no name but localhost is one of a loopback address
    checkTarget(lines[3]);
    static_cast<void>(access::Tokens::parse(text, "fuzzed"));
    if (access::checkDataName(text).ok()) {
        const std::filesystem::path path = std::filesystem::path("/data") / text;
        if (!path.lexically_normal().string().starts_with("/data/"))
            std::abort();
    }
    return 0;
}
