// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/frame/frame_source.h"
#include "eyrie/v1/scene.pb.h"

namespace eyrie::api {

/// Scenes as callers name them: files by paths that begin in the data folder. Files that the
/// server was started with may be named, too, as scene() names them. Any thread may call.
class SceneDesk {
public:
    /// `folder` and `frames` outlive it.
    SceneDesk(const std::optional<access::DataFolder>& folder, coordinator::FrameSource& frames,
              std::function<void(fabric::Scene)> setScene);

    /// The scene's files may be named from now on.
    void allow(const fabric::Scene& scene);

    v1::Scene scene() const;

    /// Errors: InvalidArgument, naming the object and field; NotFound (a file).
    absl::Status show(v1::Scene scene);

private:
    absl::StatusOr<std::string> pathOf(const std::string& name, const char* ending) const;

    const std::optional<access::DataFolder>& folder_;
    coordinator::FrameSource& frames_;
    const std::function<void(fabric::Scene)> setScene_;
    mutable std::mutex mutex_;  ///< guards allowed_
    std::set<std::string> allowed_;
};

}  // namespace eyrie::api
