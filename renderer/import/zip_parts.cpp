// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/zip_parts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

#include <minizip/unzip.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

/// The name of the part that the archive is at; empty where it has none.
std::string nameOfPart(unzFile archive) {
    std::array<char, 1024> name{};
    const int read = unzGetCurrentFileInfo64(archive, nullptr, name.data(), name.size() - 1,
                                             nullptr, 0, nullptr, 0);
    return read == UNZ_OK ? name.data() : "";
}

std::string unpackPart(unzFile archive) {
    std::string part;
    if (unzOpenCurrentFile(archive) != UNZ_OK)
        return part;
    std::array<char, 65536> buffer;
    for (int count = 1; count > 0;) {
        count = unzReadCurrentFile(archive, buffer.data(), buffer.size());
        part.append(buffer.data(), static_cast<std::size_t>(std::max(count, 0)));
    }
    unzCloseCurrentFile(archive);
    return part;
}

}  // namespace

absl::Status forEachZipPart(const std::string& path, std::string_view ending,
                            const std::function<absl::Status(std::string_view part)>& use) {
    const std::unique_ptr<void, decltype(&unzClose)> archive(unzOpen64(path.c_str()), &unzClose);
    if (!archive)
        return absl::OkStatus();
    for (int at = unzGoToFirstFile(archive.get()); at == UNZ_OK;
         at = unzGoToNextFile(archive.get()))
        if (nameOfPart(archive.get()).ends_with(ending))
            RETURN_IF_ERROR(use(unpackPart(archive.get())));
    return absl::OkStatus();
}

}  // namespace eyrie::import
