// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coordinator/farm/registry.h"
#include "coordinator/frame/member.h"
#include "fabric/scene.h"

namespace eyrie::coordinator {

/// The renderers that draw: follows the registry, has every living renderer open the scene, and
/// knows which are ready. All functions may be called from any thread.
class Crew {
public:
    struct State {
        std::shared_ptr<const fabric::Scene> scene;
        fabric::SceneInfo sceneInfo;  ///< what the first renderer found in it
        std::uint64_t revision = 0;   ///< of the scene; counts up
        int ready = 0;
        int opening = 0;
        std::string openError;  ///< of the last renderer that could not open the scene
    };

    /// `registry` outlives the crew. `changed` is called, without locks held, after each change of
    /// state().
    Crew(Registry& registry, std::chrono::milliseconds openTimeout, std::function<void()> changed);

    /// Ends all calls to renderers and waits for them.
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    /// Renderers take part again once they have opened it.
    void setScene(fabric::Scene scene);

    /// Those that have the scene of `revision` open, in the order of registration; none when
    /// another scene is set.
    std::vector<std::shared_ptr<Member>> ready(std::uint64_t revision) const;

    /// Gives the renderer up where `status` says that it is gone, has lost its state, or is out of
    /// order. What may be the task's fault (InvalidArgument, ResourceExhausted, a corrupt file) is
    /// not held against it.
    void noteFailure(const std::string& id, const absl::Status& status);

    State state() const;

private:
    struct Seat {
        std::shared_ptr<Member> member;
        std::string openError;  ///< why it has not opened the scene; empty while it may yet
    };

    bool isReady(const Seat& seat) const;
    void follow();
    void retireMissing(const std::vector<Registry::Entry>& entries);
    void seatNew(const std::vector<Registry::Entry>& entries);
    void openIn(Seat& seat);
    void noteOpened(const std::string& id, std::uint64_t revision,
                    const absl::StatusOr<fabric::SceneInfo>& info);

    Registry& registry_;
    const std::chrono::milliseconds openTimeout_;
    const std::function<void()> changed_;

    mutable std::mutex mutex_;  ///< guards what follows
    std::shared_ptr<const fabric::Scene> scene_ = std::make_shared<fabric::Scene>();
    std::uint64_t revision_ = 1;
    bool hasInfo_ = false;
    fabric::SceneInfo info_;
    std::vector<Seat> seats_;
    /// A member may be the one whose thread finds out that it is dead: its thread is waited for
    /// later, by another.
    std::vector<std::shared_ptr<Member>> retired_;
    bool closing_ = false;

    int subscription_ = 0;
};

}  // namespace eyrie::coordinator
