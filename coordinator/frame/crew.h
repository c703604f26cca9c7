// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coordinator/farm/registry.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/member.h"
#include "coordinator/frame/open_retry.h"
#include "fabric/scene.h"

namespace eyrie::coordinator {

struct CrewOptions {
    std::chrono::milliseconds openTimeout{120'000};  ///< later it is asked once more
    PatienceOptions patience;
};

/// The renderers that draw: follows the registry, has every living renderer open the scene, and
/// knows which are ready. All functions may be called from any thread.
///
/// Only renderers that have the same data draw: the first to open the scene decides which, and one
/// that finds other files is refused until none is left that has the first one's.
class Crew {
public:
    struct State {
        std::shared_ptr<const fabric::Scene> scene;
        fabric::SceneInfo sceneInfo;  ///< what the first renderer found in it
        std::uint64_t revision = 0;   ///< of the scene and its data; counts up
        int ready = 0;
        int opening = 0;
        std::string openError;  ///< of the last renderer that could not open the scene
    };

    /// `registry` outlives the crew. `changed` is called, without locks held, after each change of
    /// state() or renderers().
    Crew(Registry& registry, const CrewOptions& options, std::function<void()> changed);

    /// Ends all calls to renderers and waits for them.
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    /// Renderers take part again once they have opened it.
    void setScene(fabric::Scene scene);

    /// Has those open it whose data could not be had or took longer than openTimeout, and whose
    /// time has come (OpenRetry). To be called now and then.
    void openAgain(Member::Clock::time_point now);

    /// Those that have the scene of `revision` open and may have new tasks, in the order of
    /// registration; none when another scene is set.
    std::vector<std::shared_ptr<Member>> ready(std::uint64_t revision) const;

    /// Gives the renderer up where `status` says that it is gone, has lost its state, or is out of
    /// order. What may be the task's fault (InvalidArgument, ResourceExhausted, a corrupt file) is
    /// not held against it.
    void noteFailure(const std::string& id, const absl::Status& status);

    /// A member has become late, or is so no longer.
    void noteLateness() { changed_(); }

    State state() const;

    /// Where others reach it; empty where the registry does not know it.
    std::string addressOf(const std::string& id) const;

    /// Every renderer that the registry lists, for people to see.
    std::vector<RendererStatus> renderers() const;

private:
    struct Seat {
        std::shared_ptr<Member> member;
        std::uint64_t opened = 0;              ///< revision that it has open, with everybody's data
        absl::Status openError;                ///< why it has not; OK while nothing is known of it
        Member::Clock::time_point since = {};  ///< of openError
        OpenRetry retry;
        bool hasOtherData = false;
        bool drains = false;
    };

    bool isReady(const Seat& seat) const;
    bool anyOpened() const;
    void follow();
    void retireMissing(const std::vector<Registry::Entry>& entries);
    void seatNew(const std::vector<Registry::Entry>& entries);
    void drain(Seat& seat);
    void openIn(Seat& seat);
    void askToOpen(Seat& seat);
    void openInAll();
    void noteOpened(const std::string& id, std::uint64_t revision,
                    const absl::StatusOr<fabric::SceneInfo>& info);
    static bool noteOpenError(Seat& seat, const absl::Status& error);
    absl::Status seatOpened(Seat& seat, const fabric::SceneInfo& info);
    void describe(const std::string& id, RendererStatus& status) const;

    Registry& registry_;
    const CrewOptions options_;
    const std::function<void()> changed_;

    mutable std::mutex mutex_;  ///< guards what follows
    std::shared_ptr<const fabric::Scene> scene_ = std::make_shared<fabric::Scene>();
    std::uint64_t revision_ = 1;
    fabric::SceneInfo info_;  ///< that those which have the scene of this revision open found
    bool hasInfo_ = false;    ///< one has had it open
    std::vector<Seat> seats_;
    /// A member may be the one whose thread finds out that it is dead: its thread is waited for
    /// later, by another.
    std::vector<std::shared_ptr<Member>> retired_;
    bool closing_ = false;

    int subscription_ = 0;
};

}  // namespace eyrie::coordinator
