// SPDX-License-Identifier: Apache-2.0
// Addresses that others name, of any bytes: of data (--allow-url), and of renderers. The first line
// is an address, the second who it comes from.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "coordinator/api/reachable_address.h"
#include "renderer/page/remote_name.h"

namespace {

using namespace eyrie;

constexpr std::string_view kAllowed = "https://data.example/dem";
constexpr std::string_view kReadAs = "/vsicurl/https://data.example/dem";

/// What is read from elsewhere lies where it is allowed, whichever way it is spelt.
void checkData(const std::string& path) {
    static const page::AllowedUrls allowed({std::string(kAllowed)});
    static const page::AllowedUrls none;
    if (!page::isRemote(path)) {
        if (page::isVirtual(path) && path.find("vsi", 4) != std::string::npos)
            std::abort();  // of this machine is one archive alone
        return;
    }
    if (none.check(path).ok())
        std::abort();
    const std::string name = page::gdalName(path);
    if (allowed.check(path).ok() &&
        (!name.starts_with(kReadAs) ||
         (name.size() > kReadAs.size() && name[kReadAs.size()] != '/') ||
         name.find("/../") != std::string::npos))
        std::abort();
    if (!path.starts_with(page::withoutQuery(path)))
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string first(text.substr(0, text.find('\n')));
    const std::string second(text.substr(std::min(first.size() + 1, text.size())));
    checkData(first);
    const std::string reached = coordinator::reachableAddress(first, second);
    const bool isEverywhere = first.starts_with("0.0.0.0:") || first.starts_with("[::]:");
    if (!isEverywhere && reached != first)
        std::abort();  // only who listens on all addresses is called by another
    return 0;
}
