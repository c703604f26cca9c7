// SPDX-License-Identifier: Apache-2.0
#include "fabric/shown_name.h"

#include <algorithm>

namespace eyrie::fabric {
namespace {

constexpr std::string_view kHidden = "…";
constexpr std::string_view kAfterScheme = "://";
constexpr std::string_view kGdalsQuery = "/vsicurl?";  // which has an address, and how to ask there

std::size_t endOf(const std::string& text, std::string_view ends, std::size_t from) {
    return std::min(text.find_first_of(ends, from), text.size());
}

void hideUser(std::string& text, std::size_t host) {
    const std::size_t at = text.rfind('@', endOf(text, "/?# \t\r\n", host));
    if (at != std::string::npos && at > host)
        text.replace(host, at - host, kHidden);
}

/// Of a sentence what is behind the address stays.
void hideQuery(std::string& text, std::size_t address) {
    std::size_t end = endOf(text, " \t\r\n\"'`<>", address);
    while (std::string_view(":;,.)").find(text[end - 1]) != std::string_view::npos) --end;
    const std::size_t query = text.find('?', address);
    if (query < end)
        text.replace(query + 1, end - query - 1, kHidden);
}

}  // namespace

std::string shownName(std::string_view name) {
    std::string shown(name);
    for (std::size_t at = 0; (at = shown.find(kAfterScheme, at)) != std::string::npos;) {
        hideUser(shown, at + kAfterScheme.size());
        hideQuery(shown, at);
        at += kAfterScheme.size();
    }
    for (std::size_t at = 0; (at = shown.find(kGdalsQuery, at)) != std::string::npos; ++at)
        hideQuery(shown, at);
    return shown;
}

}  // namespace eyrie::fabric
