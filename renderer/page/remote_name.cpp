// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/remote_name.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace eyrie::page {
namespace {

constexpr std::string_view kCurl = "/vsicurl/";
constexpr std::string_view kAny = "any";

bool isHttp(std::string_view path) {
    return path.starts_with("http://") || path.starts_with("https://");
}

/// One spelling of an address: `/vsicurl/https://…` is `https://…`.
std::string_view plain(std::string_view url) {
    return url.starts_with(kCurl) ? url.substr(kCurl.size()) : url;
}

/// Whether a part of it leads upwards, whichever way it is spelt: a prefix would say nothing then.
bool climbs(std::string_view url) {
    std::string lower(url);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower.find("..") != std::string::npos || lower.find("%2e") != std::string::npos ||
           lower.find('\\') != std::string::npos;
}

bool isUnder(std::string_view url, std::string_view prefix) {
    if (!url.starts_with(prefix))
        return false;
    return url.size() == prefix.size() || prefix.ends_with('/') || url[prefix.size()] == '/';
}

}  // namespace

bool isRemote(std::string_view path) {
    if (isHttp(path))
        return true;
    if (!path.starts_with("/vsi"))
        return false;
    const std::size_t end = path.find_first_of("/?", 4);
    return end != std::string_view::npos && end > 4 &&
           std::all_of(path.begin() + 4, path.begin() + static_cast<std::ptrdiff_t>(end),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

std::string gdalName(const std::string& url) {
    return isHttp(url) ? std::string(kCurl) + url : url;
}

std::string withoutQuery(const std::string& path) {
    return isHttp(plain(path)) ? path.substr(0, path.find_first_of("?#")) : path;
}

AllowedUrls::AllowedUrls(std::vector<std::string> prefixes) : prefixes_(std::move(prefixes)) {}

absl::Status AllowedUrls::check(const std::string& path) const {
    if (!isRemote(path))
        return absl::OkStatus();
    for (const std::string& prefix : prefixes_)
        if (prefix == kAny || (isUnder(plain(path), plain(prefix)) && !climbs(path)))
            return absl::OkStatus();
    return absl::PermissionDeniedError(fmt::format(
        "{}: this renderer may not read from there; start it with --allow-url and the beginning "
        "of the address",
        path));
}

}  // namespace eyrie::page
