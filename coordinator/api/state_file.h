// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include <absl/status/status.h>

#include "access/data_folder.h"
#include "coordinator/api/file_lock.h"
#include "coordinator/frame/kept_configuration.h"

namespace eyrie::v1 {
class KeptScene;
class KeptState;
}  // namespace eyrie::v1

namespace eyrie::api {

/// What callers have set of a coordinator, kept as state.json in its data folder for the one that
/// takes its place. Nothing of it keeps a coordinator from starting or answering: what cannot be
/// read is renamed to state.json.damaged, what cannot be written is tried again, and the log says
/// so. Of several coordinators with one folder the file is that of the first, and when that ends
/// another's, which writes there what it has by then; .state.json.lock says whose. Any thread may
/// call.
class StateFile {
public:
    /// Reads what there is. `configurationFile` says which configuration is at work; empty: one
    /// made of the renderers. The file is written at once when something has changed, but not more
    /// often than every `pause`. Where it is another's, that one is waited for, for two of them: it
    /// may be about to end, and has by then written what was set when this began.
    StateFile(access::DataFolder folder, std::string configurationFile,
              std::chrono::milliseconds pause = std::chrono::seconds(1));
    /// Writes what is not yet written, if it can.
    ~StateFile();

    /// What was set of the configuration at work; nothing where the file tells of another.
    coordinator::KeptConfiguration configuration() const;
    void keep(const coordinator::KeptConfiguration& configuration);

    v1::KeptScene scene() const;
    void keep(const v1::KeptScene& scene);
    /// The command line's is shown.
    void forgetScene();

private:
    /// Puts `now` into the place of `part`, of state_.
    template <typename Message>
    void change(const Message& now, Message& part);
    void writeChanges(const std::stop_token& stop);
    /// Whether the file is this one's to write: the lock is had, or there are none. Errors: those
    /// of FileLock, but for Unimplemented.
    absl::Status takeLock();
    absl::Status tryToWrite(const std::string& text);
    absl::Status write(const std::string& text);

    const access::DataFolder folder_;
    const std::string configurationFile_;
    const std::chrono::milliseconds pause_;
    std::optional<FileLock> lock_;
    bool isOurs_ = false;       ///< takeLock() has said so; the thread's, as are lock_ and
    std::string problem_;       ///< that was logged last
    mutable std::mutex mutex_;  ///< guards what follows
    std::condition_variable_any changed_;
    std::unique_ptr<v1::KeptState> state_;
    bool isWritten_ = true;
    std::jthread thread_;  ///< last: it ends before the rest goes
};

}  // namespace eyrie::api
