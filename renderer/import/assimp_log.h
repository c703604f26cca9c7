// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::import {

/// Hears, as long as it lives, what Assimp's log has of the parts of files that it passes over. One
/// at a time in a process.
class AssimpLog {
public:
    AssimpLog();
    ~AssimpLog();
    AssimpLog(const AssimpLog&) = delete;
    AssimpLog& operator=(const AssimpLog&) = delete;

    /// For TriangleMesh::notes: in Assimp's words, each kind once.
    std::vector<std::string> notes() const;

private:
    class Listener;
    Listener* listener_;  ///< the log's own
};

}  // namespace eyrie::import
