// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/tuned_leaf.h"

#include <cerrno>
#include <fstream>

#include "fabric/status.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::mesh {

absl::Status recordTunedLeaf(const std::string& path, std::uint32_t leafTriangles) {
    RETURN_IF_ERROR(EymFile::open(path).status());
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    EymHeader header;
    file.read(reinterpret_cast<char*>(&header), sizeof header);
    header.tunedLeafTriangles = leafTriangles;
    header.checksum = headerChecksum(header);
    file.seekp(0);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.close();
    return file.good() ? absl::OkStatus() : fabric::writeError(path, "cannot be changed", errno);
}

}  // namespace eyrie::mesh
