// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/frame/frame_source.h"
#include "eyrie/v1/scene.pb.h"

namespace eyrie::api {

class DataDesk;
class QuotaKeeper;
class StateFile;

/// Scenes as callers name them: files by paths that begin in the data folder. Files that the
/// server was started with may be named, too, as scene() names them. Any thread may call.
class SceneDesk {
public:
    /// All but `setScene` outlive it. What is shown is kept in `state`; null: nowhere.
    SceneDesk(const std::optional<access::DataFolder>& folder, DataDesk& data,
              const QuotaKeeper& quotas, coordinator::FrameSource& frames,
              std::function<void(fabric::Scene)> setScene, StateFile* state);

    /// Shows the scene that the server was started with or, where another was shown in its place
    /// before and still can be, that. Its files may be named from now on. What is shown in its
    /// place is kept for `asNamed`: the same without what was found for it in its files.
    void begin(fabric::Scene scene, fabric::Scene asNamed);

    v1::Scene scene() const;

    /// The same, but data have the names that anybody may see (fabric::shownName), by which not all
    /// can be shown again.
    v1::Scene sceneForAnybody() const;

    /// Errors: those of resolved().
    absl::Status show(v1::Scene scene, const std::stop_token& stop);

    /// `scene` by where its files lie. Errors: InvalidArgument, naming the object and field, or as
    /// it is larger than the quotas allow; NotFound (a file); FailedPrecondition (a file of the
    /// data folder that cannot be read, as far as can be told here); Cancelled after `stop`.
    absl::StatusOr<fabric::Scene> resolved(v1::Scene scene, const std::stop_token& stop) const;

    /// What is drawn now.
    fabric::Scene shown() const { return frames_.status().scene; }

private:
    absl::StatusOr<std::string> pathOf(const std::string& name, fabric::ObjectKind kind) const;
    v1::Scene named(const fabric::Scene& scene) const;
    absl::Status showKept(const fabric::Scene& commandLine, const fabric::Scene& asNamed) const;
    /// An object of a scene, by its position, and its file, by its name in the data folder.
    struct NamedFile {
        int object;
        std::string name;
    };
    absl::Status checkSize(const std::vector<NamedFile>& files, const std::stop_token& stop) const;
    absl::Status checkReach(const std::vector<NamedFile>& files, const fabric::Scene& scene,
                            const std::stop_token& stop) const;

    const std::optional<access::DataFolder>& folder_;
    DataDesk& data_;
    const QuotaKeeper& quotas_;
    coordinator::FrameSource& frames_;
    const std::function<void(fabric::Scene)> setScene_;
    StateFile* const state_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::set<std::pair<std::string, fabric::ObjectKind>> allowed_;
    fabric::Scene commandLine_;  ///< that the server was started with
    fabric::Scene asTold_;       ///< the same as who was told of it sets it again: colours round
    fabric::Scene asNamed_;      ///< the same, as begin() was told
};

}  // namespace eyrie::api
