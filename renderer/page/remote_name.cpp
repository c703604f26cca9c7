// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/remote_name.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

namespace eyrie::page {
namespace {

constexpr std::string_view kCurl = "/vsicurl/";
constexpr std::string_view kAny = "any";

/// Of `s3://…` "s3", whatever its case; "" of what has none.
std::string schemeOf(std::string_view path) {
    const std::size_t end = path.find("://");
    if (end == std::string_view::npos)
        return "";
    const std::string scheme = absl::AsciiStrToLower(std::string(path.substr(0, end)));
    const auto isOfOne = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '+' || c == '.' || c == '-';
    };
    return std::ranges::all_of(scheme, isOfOne) ? scheme : "";
}

bool isHttp(std::string_view path) {
    const std::string scheme = schemeOf(path);
    return scheme == "http" || scheme == "https";
}

/// With its scheme as GDAL knows it.
std::string inLowerCase(std::string_view url) {
    const std::string scheme = schemeOf(url);
    return scheme + std::string(url.substr(scheme.size()));
}

/// One spelling of an address: `/vsicurl/HTTPS://…` is `https://…`.
std::string plain(std::string_view url) {
    return inLowerCase(url.starts_with(kCurl) ? url.substr(kCurl.size()) : url);
}

/// Whether a part of it leads upwards, whichever way it is spelt: a prefix would say nothing then.
bool climbs(std::string_view url) {
    const std::string lower = absl::AsciiStrToLower(std::string(url));
    return lower.find("..") != std::string::npos || lower.find("%2e") != std::string::npos ||
           lower.find('\\') != std::string::npos;
}

bool isUnder(std::string_view url, std::string_view prefix) {
    if (!url.starts_with(prefix))
        return false;
    return url.size() == prefix.size() || prefix.ends_with('/') || url[prefix.size()] == '/';
}

/// An archive's name that has in it what could lead elsewhere, however GDAL takes that, is none.
bool isLocalArchive(std::string_view path) {
    for (const std::string_view archive : {"/vsizip/", "/vsitar/", "/vsigzip/"}) {
        if (!path.starts_with(archive))
            continue;
        const std::string within = absl::AsciiStrToLower(std::string(path.substr(archive.size())));
        return within.find("vsi") == std::string::npos && within.find("://") == std::string::npos;
    }
    return false;
}

}  // namespace

bool isRemote(std::string_view path) { return isVirtual(path) && !isLocalArchive(path); }

bool isVirtual(std::string_view path) {
    if (isHttp(path))
        return true;
    if (!path.starts_with("/vsi"))
        return false;
    const std::size_t end = path.find_first_of("/?", 4);
    return end != std::string_view::npos && end > 4 &&
           std::all_of(path.begin() + 4, path.begin() + static_cast<std::ptrdiff_t>(end),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

absl::Status checkScheme(const std::string& path) {
    const std::string scheme = schemeOf(path);
    if (scheme.empty() || isHttp(path))
        return absl::OkStatus();
    const std::string remedy =
        scheme == "s3" || scheme == "gs"
            ? fmt::format("write /vsi{}/{} (docs/operations.md)", scheme,
                          path.substr(scheme.size() + 3))
            : "download the file, or name it as GDAL does (docs/operations.md)";
    return absl::InvalidArgumentError(fmt::format(
        "{}: what begins with http://, https:// or /vsi is read from elsewhere, and {}:// is not; "
        "{}",
        path, scheme, remedy));
}

bool isPlainPath(const std::string& path) { return !isVirtual(path) && checkScheme(path).ok(); }

std::string gdalName(const std::string& url) {
    const std::string address = plain(url);
    return isHttp(address) ? std::string(kCurl) + address : url;
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
