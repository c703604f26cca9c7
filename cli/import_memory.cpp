// SPDX-License-Identifier: Apache-2.0
#include "cli/import_memory.h"

#include <algorithm>
#include <fstream>

#include <unistd.h>

#include "renderer/import/mesh_import.h"

namespace eyrie::cli {

std::uint64_t defaultMeshMemory() {
    std::uint64_t bytes = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    for (const char* const file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
        if (std::uint64_t limit = 0; std::ifstream(file) >> limit)  // no number: no limit
            bytes = std::min(bytes, limit);
    return std::max(bytes / 2, import::kLeastMeshMemory);
}

}  // namespace eyrie::cli
