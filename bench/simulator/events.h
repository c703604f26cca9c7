// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace eyrie::simulator {

using Id = std::size_t;

/// Work that goes on at once on shared resources, from one change to the next (discrete events).
///
/// All who use a resource at a time have equal parts of its rate, and each goes on as fast as the
/// slowest of its resources and its own limit let it: processor cores shared by threads, links
/// shared by streams.
class Events {
public:
    /// What `rate` units of work get done on in a millisecond.
    Id addResource(double rate);

    /// Work that starts once all in `after` are done. `most` units a millisecond at most; without
    /// resources as many as that.
    Id addActivity(double work, double most, std::vector<Id> resources, std::vector<Id> after);
    /// Something that takes its time whatever else goes on.
    Id addDelay(double milliseconds, std::vector<Id> after);

    /// One more to wait for; before run().
    void addDependency(Id activity, Id after);

    /// Runs everything; after it, doneAt of each. False when some wait for each other.
    bool run();

    double doneAt(Id activity) const { return activities_[activity].done; }
    /// Milliseconds of work at full rate that a resource did, over the rate.
    double busy(Id resource) const { return resources_[resource].used; }

private:
    struct Resource {
        double rate = 1;
        std::size_t users = 0;
        double used = 0;
    };
    struct Activity {
        double left = 0;
        double most = 1;
        std::vector<Id> resources;
        std::vector<Id> next;
        std::size_t waitsFor = 0;
        double rate = 0;
        double done = -1;
    };
    void start(Id activity);
    void finish(Id activity);
    double rateOf(const Activity& activity) const;

    std::vector<Resource> resources_;
    std::vector<Activity> activities_;
    std::vector<Id> running_;
    double now_ = 0;
    std::size_t finished_ = 0;
};

}  // namespace eyrie::simulator
